// Every reference value that needs the language alone.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/core/function/evaluate.h"
#include "tests/shared_data.h"

namespace lightwalk::test {
namespace {

const std::string kPrelude = R"(
va(i) = select(i,1,2,3);  vb(i) = select(i,4,5,6);
fac(n) : if(n-1.5, n*fac(n-1), 1);   fib(n) = if(n-1.5, fib(n-1)+fib(n-2), n);
app(f,x) = f(x);  comp(f,g,x) = f(g(x));  first(a,b) = a;  second(a,b) = b;
nargs3(a,b,c) = select(0,a,b,c);
x3 = .3;  y1 = .1;  z = 0;  m8 = -8;  o = 1;  K : 3;  kk = 3;
)";
const std::string kFaulty = "m8=-8; z=0; o=1; bad=sqrt(m8); good=sin(o);";

struct Row {
    std::string group, setup, expression, value;
    double tolerance = 0;
};

std::vector<Row> read_rows(const std::string& path) {
    std::ifstream in(path);
    std::vector<Row> rows;
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        Row row;
        std::string tolerance;
        for (std::string* field :
             {&row.group, &row.setup, &row.expression, &row.value, &tolerance}) {
            std::getline(fields, *field, '\t');
        }
        if (line.empty() || line[0] == '#' || row.group == "group") continue;
        if (row.group != "brighttext") row.tolerance = std::stod(tolerance);
        rows.push_back(row);
    }
    return rows;
}

/// A ray of direction (.1, -.2, -1) from (.25, .5, 3) onto the plane z = 0.
ChannelValues slanted() {
    ChannelValues channels = straight_down();
    const double n = std::sqrt(1.05);
    set(channels, Channel::Dx, .1 / n);
    set(channels, Channel::Dy, -.2 / n);
    set(channels, Channel::Dz, -1 / n);
    set(channels, Channel::Px, .55);
    set(channels, Channel::Py, -.1);
    set(channels, Channel::Rdot, 1 / n);
    set(channels, Channel::T, 3 * n);
    set(channels, Channel::Ts, 3 * n);
    return channels;
}

Setting prism() {
    Setting setting;
    setting.channels = straight_down();
    const double n = std::sqrt(.7 * .7 + .2 * .2 + .3 * .3);
    set(setting.channels, Channel::Dx, .7 / n);
    set(setting.channels, Channel::Dy, .2 / n);
    set(setting.channels, Channel::Dz, -.3 / n);
    setting.reals = {.63, 1.18, 1, .87, 1.5, .02, 4, 1, .01, .05};
    setting.material_channels =
        channel_bit(Channel::DxA) | channel_bit(Channel::DyA) | channel_bit(Channel::DzA);
    return setting;
}

std::string outcome(const Row& row, const Setting& setting, double& value) {
    try {
        const Evaluated result = evaluate(row.expression, setting);
        value = result.value;
        return result.error == EvalError::none ? "value" : "SKIP";
    } catch (const InputError&) {
        return "FATAL";
    }
}

/// Colors are computed blue first; one error flag serves all three.
std::string color_outcome(const Row& row) {
    std::istringstream words(row.expression);
    std::vector<std::string> names(3);
    for (std::string& name : names) words >> name;
    std::reverse(names.begin(), names.end());
    const auto results = evaluate_all(names, {kFaulty, {}, 0, straight_down()});
    if (results.back().error != EvalError::none) return "SKIP";
    std::ostringstream out;
    out.precision(9);
    for (std::size_t k = 3; k-- > 0;) {
        out << static_cast<double>(static_cast<float>(results[k].value)) << (k ? " " : "");
    }
    return out.str();
}

void check_row(const Row& row, const Setting& setting) {
    CAPTURE(row.group);
    CAPTURE(row.expression);
    double value = 0;
    const std::string got = outcome(row, setting, value);
    if (row.value == "SKIP" || row.value == "FATAL") {
        CHECK(got == row.value);
        return;
    }
    REQUIRE(got == "value");
    const double expected = std::stod(row.value);
    const bool equal = value == expected || std::abs(value - expected) <=
                                                row.tolerance * std::max(1.0, std::abs(expected));
    CHECK(equal);
}

}  // namespace

TEST_CASE("the language agrees with every reference value that needs nothing else") {
    LIGHTWALK_NEEDS_SHARED(path, "spec/3-conformance.tsv");
    std::map<std::string, int> rows;
    for (const Row& row : read_rows(path)) {
        ++rows[row.group];
        if (row.group == "lang" || row.group == "lib" || row.group == "noise" ||
            row.group == "rand") {
            Row in_file = row;  // as the last definition of the file
            in_file.expression = "the_value";
            const std::string text = kPrelude + "the_value = " + row.expression + ";";
            CAPTURE(row.expression);
            check_row(in_file, {text, {}, 0, straight_down()});
        } else if (row.group == "error" && row.setup.rfind("colorfunc", 0) == 0) {
            CHECK(color_outcome(row) == row.value);
        } else if (row.group == "error") {
            check_row(row, {kFaulty, {}, 0, straight_down()});
        } else if (row.group == "source") {
            Setting setting;
            setting.channels = slanted();
            std::istringstream reals(row.setup.substr(row.setup.rfind(':') + 1));
            for (double x = 0; reals >> x;) setting.reals.push_back(x);
            check_row(row, setting);
        } else if (row.group == "fprism") {
            check_row(row, prism());
        }
    }
    CHECK(rows["lang"] == 111);
    CHECK(rows["lib"] == 95);
    CHECK(rows["noise"] == 80);
    CHECK(rows["rand"] == 14);
    CHECK(rows["error"] == 63);
    CHECK(rows["source"] == 51);
    CHECK(rows["fprism"] == 24);
}

}  // namespace lightwalk::test
