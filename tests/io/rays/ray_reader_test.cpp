#include "io/rays/ray_reader.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <array>
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

std::size_t rays_in(const std::string& text) {
    Pipe pipe(text);
    pipe.finish();
    RayReader reader(pipe.out(), NumberFormat::text);
    std::size_t count = 0;
    while (reader.next()) ++count;
    return count;
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

TEST_CASE("the input ends at an incomplete ray, a word that is no number, or one of 32 letters") {
    CHECK(rays_in("1 2 3 4 5 6 1 2 3 4 5") == 1);
    CHECK(rays_in("1 2 3 4 5 6 x 1 2 3 4 5 6") == 1);
    CHECK(rays_in("1 2 3 4 5 nan") == 0);
    CHECK(rays_in("1 2 3 4 5 " + std::string(31, '1')) == 1);
    CHECK(rays_in("1 2 3 4 5 " + std::string(32, '1')) == 0);
    CHECK(rays_in("") == 0);
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
