#include "apps/walk/kept_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "apps/commands.h"
#include "core/error.h"
#include "io/files/digest.h"
#include "parallel/comm/wire.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMostPixels = std::size_t{4} << 20;
constexpr int kLargestSide = 1 << 14;  // [pixels]

/// What stands in the file, behind the digest of its bytes.
struct KeptBytes {
    std::uint64_t scene = 0;
    KnownPicture picture;
};
template <class Wire>
void visit_fields(Wire& wire, KeptBytes& kept) {
    wire(kept.scene, kept.picture);
}

bool is_sound(const KnownPicture& known) {
    return known.width > 0 && known.width < kLargestSide && known.height > 0 &&
           known.height < kLargestSide &&
           known.values.size() ==
               static_cast<std::size_t>(known.width) * static_cast<std::size_t>(known.height);
}

}  // namespace

KeptPicture::KeptPicture(std::string path, const FileStates& scene) : path_(std::move(path)) {
    std::string all = LIGHTWALK_VERSION;
    for (const auto& [name, state] : scene)
        all += '\n' + name + '\n' + std::to_string(static_cast<int>(state.exists)) + ' ' +
               std::to_string(state.written.time_since_epoch().count()) + ' ' +
               std::to_string(state.size);
    scene_ = digest_of_bytes(all);
}

std::optional<KnownPicture> KeptPicture::read() const {
    std::ifstream file(path_, std::ios::binary);
    std::ostringstream text;
    if (!(text << file.rdbuf())) return std::nullopt;
    const std::string bytes = std::move(text).str();
    try {
        std::uint64_t digest = 0;
        if (bytes.size() < sizeof digest) return std::nullopt;
        const std::string_view rest = std::string_view(bytes).substr(sizeof digest);
        std::copy_n(bytes.data(), sizeof digest, reinterpret_cast<char*>(&digest));
        if (digest != digest_of_bytes(rest)) return std::nullopt;
        auto kept = wire::decode<KeptBytes>(rest);
        if (kept.scene != scene_ || !is_sound(kept.picture)) return std::nullopt;
        return std::move(kept.picture);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

void KeptPicture::write(KnownPicture& known) const {
    if (!is_sound(known) || known.values.size() > kMostPixels) return;
    KeptBytes kept{scene_, std::move(known)};
    const std::string bytes = wire::encode(kept);
    known = std::move(kept.picture);
    const std::uint64_t digest = digest_of_bytes(bytes);
    // A reader finds the one before until it is whole. Nothing is lost where that fails.
    const std::string part = path_ + ".part";
    std::error_code failed;
    {
        std::ofstream file(part, std::ios::binary | std::ios::trunc);
        file.write(reinterpret_cast<const char*>(&digest), sizeof digest);
        file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        if (!file.flush()) return (void)std::filesystem::remove(part, failed);
    }
    std::filesystem::rename(part, path_, failed);
}

std::shared_ptr<const KeptPicture> kept_picture(const FileStates& scene) {
    const char* const path = std::getenv(kWalkKept);  // NOLINT(concurrency-mt-unsafe)
    if (path == nullptr || *path == 0) return nullptr;
    return std::make_shared<const KeptPicture>(path, scene);
}

}  // namespace lightwalk
