// What is kept of a picture comes back as it was, or not at all.
#include "apps/walk/kept_picture.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "tests/apps/program.h"
#include "tests/temporary_folder.h"

namespace lightwalk::test {
namespace {

KnownPicture small_picture() {
    KnownPicture known;
    known.view.position = {1, 2, 3};
    known.width = 3;
    known.height = 2;
    known.indirect = true;
    for (int i = 0; i < 6; ++i)
        known.values.push_back({{static_cast<float>(i), 1, 2}, static_cast<float>(i)});
    return known;
}

FileStates room_of(std::uintmax_t size) {
    return {{"room.rad", {true, {}, size}}, {"missing.cal", {}}};
}

}  // namespace

TEST_CASE("kept picture: it comes back as it was, and only to a scene of the same files") {
    const TemporaryFolder folder;
    const std::string path = folder.path("picture");
    const KeptPicture kept(path, room_of(7));
    CHECK_FALSE(kept.read());
    KnownPicture known = small_picture();
    kept.write(known);
    CHECK(known.values == small_picture().values);
    const auto back = kept.read();
    REQUIRE(back);
    CHECK(back->view == known.view);
    CHECK(back->width == 3);
    CHECK(back->indirect);
    CHECK(back->values == known.values);
    CHECK(KeptPicture(path, room_of(7)).read());
    CHECK_FALSE(KeptPicture(path, room_of(8)).read());
    CHECK_FALSE(KeptPicture(path, {}).read());
    KnownPicture broken = small_picture();
    broken.values.pop_back();
    kept.write(broken);
    CHECK(kept.read());  // the one before
}

TEST_CASE(
    "kept picture: what is damaged is as if there were none, and a folder that is gone is no "
    "mistake") {
    const TemporaryFolder folder;
    const std::string path = folder.path("picture");
    const KeptPicture kept(path, room_of(7));
    KnownPicture known = small_picture();
    kept.write(known);
    const std::string bytes = read_whole(path);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        (void)folder.write("picture", bytes.substr(0, i));
        CHECK_FALSE(kept.read());
        std::string other = bytes;
        other[i] = static_cast<char>(other[i] ^ 4);
        (void)folder.write("picture", other);
        CHECK_FALSE(kept.read());
    }
    const KeptPicture nowhere(folder.path("gone/picture"), room_of(7));
    nowhere.write(known);
    CHECK_FALSE(nowhere.read());
    CHECK_FALSE(std::filesystem::exists(path + ".part"));
}

}  // namespace lightwalk::test
