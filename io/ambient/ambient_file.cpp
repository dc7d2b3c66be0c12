#include "io/ambient/ambient_file.h"

#include <cstdlib>
#include <optional>

#include "core/error.h"
#include "core/math/portable_numbers.h"
#include "io/formats/header.h"

namespace lightwalk {
namespace {

constexpr std::int64_t kMagic = 561;
constexpr int kMagicSize = 2;  ///< bytes
constexpr const char* kFormat = "Radiance_ambval";

/// Whether the header names three channels, or no number of channels.
bool has_three_channels(const InfoHeader& header) {
    for (const std::string& line : header.lines) {
        if (const auto value = header_variable(line, "NCOMP")) return *value == "3";
    }
    return true;
}

}  // namespace

AmbientFile decode_ambient_file(std::string_view bytes, const std::string& name) {
    const InfoHeader header = decode_header(bytes, name);
    if (header.format != kFormat)
        throw InputError({name, 0}, "not an ambient file, expected FORMAT=Radiance_ambval");
    if (!has_three_channels(header))
        throw InputError({name, 0},
                         "an ambient file of other than three channels is not supported");
    AmbientFile file;
    file.header = header.lines;
    std::string_view rest = bytes.substr(header.size);
    if (rest.size() < kMagicSize) throw InputError({name, 0}, "truncated ambient file");
    if (take_integer(rest, kMagicSize) != kMagic)
        throw InputError({name, 0}, "an ambient file of another version of Radiance");
    file.size = header.size + kMagicSize;
    for (; rest.size() >= kAmbientRecordSize; rest.remove_prefix(kAmbientRecordSize)) {
        const AmbientRecord record = decode_ambient_record(rest);
        if (const auto wrong = ambient_record_problem(record)) {
            file.damage = "record " + std::to_string(file.records.size() + 1) + " has " + *wrong;
            return file;
        }
        file.records.push_back(record);
        file.size += kAmbientRecordSize;
    }
    if (!rest.empty()) file.damage = "the last record is incomplete";
    return file;
}

std::string encode_ambient_header(const std::vector<std::string>& lines) {
    std::string out = "#?RADIANCE\n";
    for (const std::string& line : lines) out += line + "\n";
    out += "NCOMP=3\nFORMAT=" + std::string(kFormat) + "\n\n";
    append_integer(out, static_cast<std::uint64_t>(kMagic), kMagicSize);
    return out;
}

}  // namespace lightwalk
