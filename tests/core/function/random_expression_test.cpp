// Compiled programs against an evaluator that does what the language's rules say, word by word.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/math/elementary.h"
#include "tests/core/function/evaluate.h"

namespace lightwalk::test {
namespace {

/// An expression without numbers: nothing is folded or flattened while it is parsed.
struct Tree {
    std::string op;
    std::vector<Tree> kids;
};

// Variables are built of each other, and fail in all ways; functions use arguments never, once,
// twice.
const std::string kDefinitions = R"(
v0 = sqrt(Px);   v1 = Py/Pz;   v2 = v0*v1;   v3 = log(v1)+Px;   v4 = if(v3,v0,Pz);   v5 = A1^v2;
twice(x) = x+x;   lazy(c,x) = if(c,x,c);   late(x,y) = if(y,x,x*y);   unused(x,y) = y;
down(n,x) = if(n-Pz, down(n-A1,x), x);   apply(f,x) = f(x);
)";
const std::vector<std::string> kLeaves{"Px", "Py", "Pz", "A1", "A2", "v0",
                                       "v1", "v2", "v3", "v4", "v5"};
const std::map<std::string, Tree> kVariables{
    {"v0", {"sqrt", {{"Px", {}}}}},
    {"v1", {"/", {{"Py", {}}, {"Pz", {}}}}},
    {"v2", {"*", {{"v0", {}}, {"v1", {}}}}},
    {"v3", {"+", {{"log", {{"v1", {}}}}, {"Px", {}}}}},
    {"v4", {"if", {{"v3", {}}, {"v0", {}}, {"Pz", {}}}}},
    {"v5", {"^", {{"A1", {}}, {"v2", {}}}}},
};

std::string text(const Tree& t) {
    if (t.kids.empty()) return t.op;
    if (t.op == "negate") return "-(" + text(t.kids[0]) + ")";
    if (std::string("+-*/^").find(t.op) != std::string::npos) {
        return "(" + text(t.kids[0]) + ")" + t.op + "(" + text(t.kids[1]) + ")";
    }
    if (t.op == "apply_sqrt") return "apply(sqrt," + text(t.kids[0]) + ")";
    std::string all = t.op + "(";
    for (std::size_t i = 0; i < t.kids.size(); ++i) all += (i ? "," : "") + text(t.kids[i]);
    return all + ")";
}

/// The rules, naively.
class Reference {
  public:
    Reference(const ChannelValues& channels, const std::vector<double>& reals)
        : channels_(channels), reals_(reals) {}

    EvalError error = EvalError::none;

    double operator()(const Tree& t) {
        const std::string& op = t.op;
        if (t.kids.empty()) return leaf(op);
        if (op == "negate") return -(*this)(t.kids[0]);
        if (op == "+" || op == "*" || op == "-") return plain(t);
        if (op == "/") return quotient(t);
        if (op == "^")
            return checked(op, [&] {
                const double y = (*this)(t.kids[1]);
                return std::pow((*this)(t.kids[0]), y);
            });
        if (op == "abs" || op == "frac" || op == "mod") return remainder(t);
        if (op == "twice" || op == "lazy" || op == "late" || op == "unused" || op == "down")
            return user(t);
        return checked(op, [&] { return library(t); });
    }

  private:
    using Argument = std::function<double()>;

    double leaf(const std::string& name) {
        if (name == "Px" || name == "Py" || name == "Pz") {
            return channels_[static_cast<std::size_t>(Channel::Px) +
                             static_cast<std::size_t>(name[1] - 'x')];
        }
        const auto known = cache_.find(name);
        if (known != cache_.end()) return known->second;
        double value = 0;
        if (name[0] == 'A') {
            error = EvalError::none;  // arg() is a library function
            value = reals_[static_cast<std::size_t>(name[1] - '1')];
        } else {
            value = (*this)(kVariables.at(name));
        }
        return cache_[name] = value;
    }

    double plain(const Tree& t) {
        const double a = (*this)(t.kids[0]);
        const double b = (*this)(t.kids[1]);
        if (t.op == "+") return 0.0 + a + b;
        return t.op == "*" ? a * b : a - b;
    }

    double quotient(const Tree& t) {
        const double b = (*this)(t.kids[1]);
        if (b == 0) {
            error = EvalError::range;
            return 0;
        }
        return (*this)(t.kids[0]) / b;
    }

    template <class Operation>
    double checked(const std::string&, const Operation& operation) {
        error = EvalError::none;
        const double v = operation();
        if (error == EvalError::none && std::isnan(v)) error = EvalError::domain;
        if (error == EvalError::none && std::isinf(v)) error = EvalError::range;
        return error == EvalError::none ? v : 0;
    }

    double library(const Tree& t) {
        const auto x = [&](std::size_t i) { return (*this)(t.kids[i]); };
        if (t.op == "if") return x(0) > 0 ? x(1) : x(2);
        if (t.op == "select") {
            const double n = x(0);
            const double m = static_cast<double>(t.kids.size() - 1);
            const double k = std::trunc(n + 0.5);
            if (!(n >= -0.5) || k > m) {
                error = EvalError::domain;
                return 0;
            }
            return k == 0 ? m : x(static_cast<std::size_t>(k));
        }
        if (t.op == "min" || t.op == "max") {
            double best = x(0);
            for (std::size_t i = t.kids.size(); --i > 0;) {
                const double v = x(i);
                if (t.op == "min" ? v < best : v > best) best = v;
            }
            return best;
        }
        if (t.op == "atan2") {
            const double y = x(0);
            return std::atan2(y, x(1));
        }
        const double v = x(0);
        if (t.op == "sqrt" || t.op == "apply_sqrt") return std::sqrt(v);
        if (t.op == "log") return std::log(v);
        if (t.op == "exp") return elementary::exp(v);
        return t.op == "sin" ? std::sin(v) : std::floor(v);
    }

    double remainder(const Tree& t) {
        const Argument n = by_need(t.kids[0]);
        if (t.op == "abs") {
            return checked("max", [&] {
                const double x = n();
                return -x > x ? -x : x;
            });
        }
        const double x = n();
        if (t.op == "frac") return x - checked("floor", [&] { return std::floor(x); });
        const Argument d = by_need(t.kids[1]);
        const double whole = checked("floor", [&] {
            if (d() != 0) return std::floor(x / d());
            error = EvalError::range;
            return 0.0;
        });
        return x - whole * d();
    }

    /// By need: an argument is computed when it is first used, and kept.
    Argument by_need(const Tree& t) {
        auto value = std::make_shared<std::optional<double>>();
        return [this, &t, value] {
            if (!*value) *value = (*this)(t);
            return **value;
        };
    }

    double user(const Tree& t) {
        const Argument x = by_need(t.kids[0]);
        if (t.op == "twice") {
            const double a = x();
            return 0.0 + a + x();
        }
        const Argument y = by_need(t.kids[1]);
        if (t.op == "lazy") return checked("if", [&] { return x() > 0 ? y() : x(); });
        if (t.op == "late") {
            return checked("if", [&] {
                if (y() > 0) return x();
                const double a = x();
                return a * y();
            });
        }
        return t.op == "unused" ? y() : down(x, y);
    }

    double down(const Argument& n, const Argument& x) {
        if (++depth_ > 60) throw InputError("deep");
        const double v = checked("if", [&] {
            const double a = n();
            if (!(a - leaf("Pz") > 0)) return x();
            auto value = std::make_shared<std::optional<double>>();
            const Argument less = [this, &n, value] {
                if (!*value) {
                    const double m = n();
                    *value = m - leaf("A1");
                }
                return **value;
            };
            return down(less, x);
        });
        --depth_;
        return v;
    }

    const ChannelValues& channels_;
    const std::vector<double>& reals_;
    std::map<std::string, double> cache_;
    int depth_ = 0;
};

class Generator {
  public:
    explicit Generator(unsigned seed) : random_(seed) {}

    int below(std::size_t n) { return static_cast<int>(random_() % n); }

    Tree tree(int depth) {
        if (depth == 0 || below(6) == 0)
            return {kLeaves[static_cast<std::size_t>(below(kLeaves.size()))], {}};
        struct Kind {
            std::string op;
            std::size_t kids;
        };
        static const std::vector<Kind> kinds{
            {"+", 2},      {"-", 2},    {"*", 2},    {"/", 2},      {"/", 2},    {"^", 2},
            {"negate", 1}, {"if", 3},   {"if", 3},   {"select", 4}, {"min", 3},  {"max", 2},
            {"atan2", 2},  {"sqrt", 1}, {"log", 1},  {"exp", 1},    {"sin", 1},  {"floor", 1},
            {"twice", 1},  {"lazy", 2}, {"late", 2}, {"unused", 2}, {"down", 2}, {"apply_sqrt", 1},
            {"twice", 1},  {"late", 2}, {"max", 1},  {"abs", 1},    {"frac", 1}, {"mod", 2}};
        const Kind& kind = kinds[static_cast<std::size_t>(below(kinds.size()))];
        Tree t{kind.op, {}};
        for (std::size_t i = 0; i < kind.kids; ++i) t.kids.push_back(tree(depth - 1));
        // -(-x) is x.
        if (t.op == "negate" && t.kids[0].op == "negate") return t.kids[0].kids[0];
        return t;
    }

    double number() {
        static const std::vector<double> numbers{0, 0, 1, -1, 2, .5, -2.5, 1e200, -0.0, 3, 1e-3};
        return numbers[static_cast<std::size_t>(below(numbers.size()))];
    }

  private:
    std::mt19937 random_;
};

}  // namespace

TEST_CASE("programs compute what the rules of the language say, bit for bit, errors included") {
    FunctionEnvironment environment;
    environment.load("tt.cal", kDefinitions);
    int failed = 0, compared = 0;
    for (unsigned seed = 1; seed <= 3000; ++seed) {
        Generator generator(seed);
        std::vector<Tree> trees;
        std::vector<ExpressionRequest> requests;
        for (int k = 0; k < 3; ++k) {
            trees.push_back(generator.tree(4));
            requests.push_back({text(trees.back()), -1});
        }
        const std::vector<double> reals{generator.number(), generator.number()};
        const Program program = environment.compile("tt.cal", requests, reals, 0, {"scene.rad", 1});
        EvalState state;
        ChannelValues channels{};
        for (int epoch = 0; epoch < 3; ++epoch) {
            for (const Channel c : {Channel::Px, Channel::Py, Channel::Pz})
                set(channels, c, generator.number());
            Reference reference(channels, reals);
            program.begin(state, channels);
            state.clear_error();
            try {
                for (std::size_t k = 0; k < trees.size(); ++k) {
                    const double expected = reference(trees[k]);
                    const double value = program.evaluate(k, state);
                    // Powers by constants are products, and not to the last bit what pow gives.
                    const bool has_power = requests[k].text.find('^') != std::string::npos;
                    const bool same =
                        std::bit_cast<std::uint64_t>(expected) ==
                            std::bit_cast<std::uint64_t>(value) ||
                        (std::isnan(expected) && std::isnan(value)) ||
                        (has_power && std::abs(expected - value) <= 1e-13 * std::abs(expected));
                    CAPTURE(seed);
                    CAPTURE(requests[k].text);
                    CAPTURE(reals);
                    CHECK(same);
                    CHECK(state.error == reference.error);
                    if (!same || state.error != reference.error) ++failed;
                    if (reference.error != EvalError::none) ++compared;
                }
            } catch (const InputError&) {
                break;  // recursion without end
            }
            REQUIRE(failed < 5);
        }
    }
    CHECK(compared > 1000);  // errors do happen
}

}  // namespace lightwalk::test
