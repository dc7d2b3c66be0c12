#include "io/rays/ray_reader.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

using namespace lightwalk;

namespace {

/// A pipe with `bytes` in it (less than its capacity).
class Pipe {
  public:
    explicit Pipe(const std::string& bytes) {
        REQUIRE(pipe(ends_.data()) == 0);
        send(bytes);
    }
    ~Pipe() {
        close(ends_[0]);
        finish();
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    void send(const std::string& bytes) const {
        REQUIRE(write(ends_[1], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
    }
    void finish() {
        if (open_) close(ends_[1]);
        open_ = false;
    }
    [[nodiscard]] int out() const { return ends_[0]; }

  private:
    std::array<int, 2> ends_{};
    bool open_ = true;
};

struct Reading {
    std::size_t rays = 0, misaligned_line = 0;
    std::string problem;
};

Reading reading_of(const std::string& bytes, NumberFormat format = NumberFormat::text) {
    Pipe pipe(bytes);
    pipe.finish();
    RayReader reader(pipe.out(), format);
    Reading reading;
    while (reader.next()) ++reading.rays;
    CHECK_FALSE(reader.next());
    reading.problem = reader.problem();
    reading.misaligned_line = reader.misaligned_line();
    return reading;
}

template <class Number>
std::string bytes_of(const std::vector<Number>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

}  // namespace

TEST_CASE("text rays are six numbers, whatever the lines") {
    Pipe pipe("1 2\n3 -1e0 .5\t6. \"7\" 8 9 0 0 0 ");
    pipe.finish();
    RayReader reader(pipe.out(), NumberFormat::text);
    const auto first = reader.next();
    REQUIRE(first);
    CHECK(first->origin == Vec3{1, 2, 3});
    CHECK(first->direction == Vec3{-1, .5, 6});
    CHECK_FALSE(first->is_flush());
    const auto second = reader.next();
    REQUIRE(second);
    CHECK(second->origin == Vec3{7, 8, 9});
    CHECK(second->is_flush());
    CHECK_FALSE(reader.next());
}

TEST_CASE("what is no ray is a problem with its line, after the rays before it") {
    const auto check = [](const std::string& text, std::size_t rays, const std::string& problem) {
        CAPTURE(text);
        const Reading reading = reading_of(text);
        CHECK(reading.rays == rays);
        CHECK(reading.problem == problem);
    };
    const std::string ray = "1 2 3 4 5 6\n", found = ": expected six numbers for each ray, found ";
    check("", 0, "");
    check("\r\n \n", 0, "");
    check("\n" + ray + "\n\n" + ray + "  \n", 2, "");
    check("1 2 3 4 5 6\r\n1 2 3 4 5 6\r\n", 2, "");
    check(ray + ray + "1 2 3\n", 2, "standard input:3: the last ray is incomplete: 3 of 6 numbers");
    check("1 2 3 4 5 6 1 2 3 4 5", 1,
          "standard input:1: the last ray is incomplete: 5 of 6 numbers");
    check("x y z dx dy dz\n" + ray, 0, "standard input:1" + found + "\"x\"");
    check(ray + "\n# sensors\n" + ray, 1, "standard input:3" + found + "\"#\"");
    check("1,1,2,0,0,-1\n", 0, "standard input:1" + found + "\"1,1,2,0,0,-1\"");
    check("\357\273\277" + ray, 0, "standard input:1" + found + "\"\357\273\2771\"");
    check(ray + "1 2 3 4 5 nan\n", 1, "standard input:2" + found + "\"nan\"");
    check("1 2 3 4 5 1e400", 0, "standard input:1" + found + "\"1e400\"");
    check("1 2 3 4 5 1e-400", 1, "");
    check("1 2 3 4 5 " + std::string(31, '1'), 1, "");
    check("1 2 3 4 5 " + std::string(32, '1'), 0,
          "standard input:1" + found + "\"" + std::string(32, '1') + "...\"");
    check(ray + "\"\" 2 3 4 5 6\n" + ray, 1, "standard input:2" + found + "\"\"");
}

TEST_CASE("rays may stand anywhere in the lines, but lines of other than six numbers are noted") {
    const auto line = [](const std::string& text) { return reading_of(text).misaligned_line; };
    CHECK(line("1 2 3 4 5 6\n1 2 3 4 5 6\n") == 0);
    CHECK(line("1 2 3 4 5 6 1 2 3 4 5 6\n1 2 3 4 5 6 1 2 3 4 5 6\n") == 0);
    CHECK(line("1 2 3\n4 5 6\n1 2 3\n4 5 6\n") == 0);
    CHECK(line("1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n") == 1);
    CHECK(line("1 2 3 4 5 6\n1 2 3 4 5\n1 2 3 4 5\n1 2\n") == 3);
}

TEST_CASE("binary input that ends within a ray, or holds no finite number, is a problem") {
    const std::vector<double> two(12, 0.5);
    CHECK(reading_of(bytes_of(two), NumberFormat::real64).problem.empty());
    std::vector<double> numbers = two;
    numbers.push_back(1);
    CHECK(reading_of(bytes_of(numbers), NumberFormat::real64).problem ==
          "standard input: ray 3: the last ray is incomplete: 1 of 6 numbers");
    CHECK(reading_of(bytes_of(two) + "abc", NumberFormat::real64).problem ==
          "standard input: ray 3: the last ray is incomplete");
    numbers[8] = std::numeric_limits<double>::infinity();
    const Reading infinite = reading_of(bytes_of(numbers), NumberFormat::real64);
    CHECK(infinite.rays == 1);
    CHECK(infinite.problem == "standard input: ray 2: a number is not finite");
    const std::vector<float> singles{1, 2, 3, 4, 5, std::numeric_limits<float>::quiet_NaN()};
    CHECK(reading_of(bytes_of(singles), NumberFormat::real32).problem ==
          "standard input: ray 1: a number is not finite");
    RayReader closed(-1, NumberFormat::real32);
    CHECK_FALSE(closed.next());
    CHECK(closed.problem().starts_with("standard input: ray 1: cannot be read: "));
}

TEST_CASE("binary rays are the machine's floats or doubles") {
    const std::array<float, 6> singles{1, 2, 3, 4, 5, 6};
    Pipe pipe(std::string(reinterpret_cast<const char*>(singles.data()), sizeof singles));
    pipe.finish();
    RayReader reader(pipe.out(), NumberFormat::real32);
    CHECK(reader.next()->direction == Vec3{4, 5, 6});
    const std::array<double, 7> doubles{.1, .2, .3, .4, .5, .6, .7};
    Pipe other(std::string(reinterpret_cast<const char*>(doubles.data()), sizeof doubles));
    other.finish();
    RayReader precise(other.out(), NumberFormat::real64);
    CHECK(precise.next()->origin == Vec3{.1, .2, .3});
    CHECK_FALSE(precise.next());
}

TEST_CASE("a ray is read as soon as it is there, and blanks after it are nobody's ray") {
    Pipe pipe("1 2 3 4 5 6\r\n \n");
    RayReader reader(pipe.out(), NumberFormat::text);
    CHECK(reader.next());
    CHECK(reader.drained());
    pipe.send("1 2 3 0 0 0\n1");
    CHECK(reader.next()->is_flush());
    CHECK_FALSE(reader.drained());
}

TEST_CASE("format letters: one for both, c for output only") {
    CHECK(parse_ray_formats("a")->output == NumberFormat::text);
    CHECK(parse_ray_formats("fd")->input == NumberFormat::real32);
    CHECK(parse_ray_formats("fd")->output == NumberFormat::real64);
    CHECK(parse_ray_formats("ac")->output == NumberFormat::rgbe);
    for (const std::string wrong : {"", "c", "ca", "x", "aaa"})
        CHECK_FALSE(parse_ray_formats(wrong));
}
