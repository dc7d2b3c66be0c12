#include "parallel/published_cache.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/ambient/serial_cache.h"
#include "tests/parallel/ambient_values.h"

using namespace lightwalk;
using lightwalk::test::record_at;

namespace {

/// Writes down whom it was told of, behind its own name.
class Listener final : public AmbientListener {
  public:
    Listener(std::string name, std::vector<std::string>& heard)
        : name_(std::move(name)), heard_(heard) {}
    void stored(const AmbientRecord& record, std::span<const Rgb>) override {
        heard_.push_back(name_ + std::to_string(static_cast<int>(record.position[0])));
    }

  private:
    std::string name_;
    std::vector<std::string>& heard_;
};

}  // namespace

TEST_CASE(
    "new ambient values reach the cache, then each listener in turn, and none of them while "
    "frozen") {
    SerialCache cache(ambient_limits({-1, -1, -1}, 10, .1, 64));
    PublishedCache published(cache);
    std::vector<std::string> heard;
    Listener file("file ", heard), ranks("ranks ", heard);
    published.add(file);
    published.add(ranks);
    published.insert(record_at(1));
    CHECK(heard == std::vector<std::string>{"file 1", "ranks 1"});
    CHECK(cache.size() == 1);
    CHECK(published.takes_values());

    published.freeze(true);
    CHECK_FALSE(published.takes_values());
    published.insert(record_at(2));
    CHECK(heard.size() == 2);
    CHECK(cache.size() == 1);

    published.freeze(false);
    cache.insert(record_at(3));  // from elsewhere: nobody is told
    published.insert(record_at(4));
    CHECK(heard.size() == 4);
    CHECK(heard.back() == "ranks 4");
    CHECK(cache.size() == 3);
}

TEST_CASE(
    "a value from elsewhere reaches the cache and all listeners but the one that brought it") {
    SerialCache cache(ambient_limits({-1, -1, -1}, 10, .1, 64));
    PublishedCache published(cache);
    std::vector<std::string> heard;
    Listener file("file ", heard), ranks("ranks ", heard);
    published.add(file);
    published.add(ranks);
    for (const bool frozen : {false, true}) {
        published.freeze(frozen);
        published.take_over(record_at(5), {}, ranks);
    }
    CHECK(heard == std::vector<std::string>{"file 5", "file 5"});
    CHECK(cache.size() == 2);
}
