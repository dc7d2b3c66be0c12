#include "io/contributions/contribution_files.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "io/formats/header.h"
#include "io/options/option_words.h"

namespace lightwalk {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kEnough = std::size_t{1} << 22;         ///< bytes that are worth writing
constexpr std::size_t kLongestHeader = std::size_t{1} << 20;  // [bytes]
constexpr std::size_t kChunk = std::size_t{1} << 20;          ///< bytes that are copied at once

[[noreturn]] void fail(const std::string& file, const std::string& what, int code) {
    throw InputError({file, 0}, what + ": " + std::generic_category().message(code));
}

void write_bytes(const std::string& file, std::string_view bytes, const char* mode) {
    struct Close {
        void operator()(std::FILE* open) const { (void)std::fclose(open); }
    };
    std::unique_ptr<std::FILE, Close> open(std::fopen(file.c_str(), mode));
    if (!open) fail(file, "cannot open for writing", errno);
    const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), open.get()) == bytes.size();
    if (std::fclose(open.release()) != 0 || !whole) fail(file, "cannot write", errno);
}

std::string bytes_of(const std::string& file, std::size_t begin, std::size_t size) {
    std::ifstream in(file, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(begin));
    std::string bytes(size, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (in.bad() || !in.is_open()) fail(file, "cannot read", EIO);
    bytes.resize(static_cast<std::size_t>(in.gcount()));
    return bytes;
}

/// Lines from `begin` on, and where the first `most` of them end.
struct Lines {
    std::uint64_t count = 0;
    std::size_t end = 0;
};
Lines whole_lines(const std::string& file, std::size_t begin, std::uint64_t most) {
    Lines lines{0, begin};
    for (std::size_t at = begin; lines.count < most;) {
        const std::string chunk = bytes_of(file, at, kChunk);
        for (std::size_t i = 0; i < chunk.size() && lines.count < most; ++i) {
            if (chunk[i] != '\n') continue;
            ++lines.count;
            lines.end = at + i + 1;
        }
        at += chunk.size();
        if (chunk.size() < kChunk) break;
    }
    return lines;
}

bool is_file(const std::string& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
}

std::string value_of(const InfoHeader& header, std::string_view name) {
    for (const std::string& line : header.lines)
        if (const auto value = header_variable(line, name)) return std::string(*value);
    return {};
}

}  // namespace

ContributionFiles::ContributionFiles(ContributionWriting writing) : writing_(std::move(writing)) {
    std::size_t columns = 0;
    for (const ContributionOutput& output : writing_.outputs) columns += output.columns.size();
    sums_.resize(3 * columns);
    targets_.resize(writing_.outputs.size());
    const bool continues = writing_.existing == ExistingOutputs::continue_;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        const std::string& file = writing_.outputs[i].file;
        if (file.empty()) {
            if (continues) throw UsageError("option -r: it needs files to go on with: expected -o");
            continue;
        }
        std::error_code error;
        targets_[i].renamed = !fs::exists(file, error) || is_file(file);
        targets_[i].part = targets_[i].renamed ? file + ".part" : file;
        if (writing_.existing == ExistingOutputs::refuse && is_file(file))
            throw InputError({file, 0}, "exists already: -fo replaces it, -r goes on with it");
    }
    if (continues)
        take_up();
    else
        for (std::size_t i = 0; i < targets_.size(); ++i) open(i);
}

std::string ContributionFiles::header(const ContributionOutput& output) const {
    return writing_.with_header ? writing_.format.header(output, writing_.history) : std::string();
}

void ContributionFiles::open(std::size_t i) {
    const std::string text = header(writing_.outputs[i]);
    Target& target = targets_[i];
    if (target.part.empty())
        target.pending = text;
    else
        write_bytes(target.part, text, "wb");
}

/// What an earlier run has left of an output: parts before whole files.
ContributionFiles::Found ContributionFiles::examine(std::size_t i) const {
    const ContributionOutput& output = writing_.outputs[i];
    Found found;
    for (const std::string& path : {targets_[i].part, output.file})
        if (found.path.empty() && is_file(path) && fs::file_size(path) > 0) found.path = path;
    if (found.path.empty()) return found;
    if (writing_.with_header) {
        const std::string head = bytes_of(found.path, 0, kLongestHeader);
        const InfoHeader old = decode_header(head, found.path);
        const std::string expected = writing_.format.header(output, {});
        const InfoHeader wanted = decode_header(expected, found.path);
        for (const char* name : {"NCOLS", "NROWS"})
            if (value_of(old, name) != value_of(wanted, name))
                throw InputError({found.path, 0}, std::string("cannot go on: it has ") + name +
                                                      '=' + value_of(old, name) + ", expected " +
                                                      value_of(wanted, name));
        if (old.format != wanted.format)
            throw InputError({found.path, 0}, "cannot go on: its format is " + old.format +
                                                  ", expected " + wanted.format);
        found.begin = old.size + expected.size() - wanted.size;  // with the resolution line
    }
    const std::size_t size = writing_.format.record_size(output.columns.size());
    const std::size_t all = fs::file_size(found.path);
    if (size == 0)
        found.records =
            whole_lines(found.path, found.begin, std::numeric_limits<std::uint64_t>::max()).count;
    else
        found.records = all > found.begin ? (all - found.begin) / size : 0;
    return found;
}

/// Goes on behind the records that all outputs have; of a single one (-c 0) the numbers are added.
void ContributionFiles::take_up() {
    std::vector<Found> found;
    std::uint64_t records = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        found.push_back(examine(i));
        records = std::min(records, found.back().records);
    }
    if (writing_.rays == 0 && records > 0)
        for (std::size_t i = 0; i < targets_.size(); ++i) add_record(found[i], i);
    if (writing_.rays == 0) records = 0;
    rays_done_ = records * static_cast<std::uint64_t>(writing_.rays);
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        if (records == 0) {
            open(i);
            continue;
        }
        const std::size_t size = writing_.format.record_size(writing_.outputs[i].columns.size());
        const std::string& part = targets_[i].part;
        const std::size_t end = size == 0
                                    ? whole_lines(found[i].path, found[i].begin, records).end
                                    : found[i].begin + static_cast<std::size_t>(records) * size;
        if (found[i].path != part) {
            std::error_code error;
            fs::copy_file(found[i].path, part, fs::copy_options::overwrite_existing, error);
            if (error) fail(part, "cannot write", error.value());
        }
        std::error_code error;
        fs::resize_file(part, end, error);
        if (error) fail(part, "cannot write", error.value());
    }
}

void ContributionFiles::add_record(const Found& found, std::size_t i) {
    const ContributionOutput& output = writing_.outputs[i];
    std::size_t size = writing_.format.record_size(output.columns.size());
    if (size == 0) size = whole_lines(found.path, found.begin, 1).end - found.begin;
    if (!writing_.format.add(output, bytes_of(found.path, found.begin, size), sums_))
        throw InputError({found.path, 0}, "cannot go on: its record is not of numbers");
}

void ContributionFiles::put_record(double scale) {
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        const std::size_t before = targets_[i].pending.size();
        writing_.format.append(writing_.outputs[i], sums_, scale, targets_[i].pending);
        pending_bytes_ += targets_[i].pending.size() - before;
    }
    std::fill(sums_.begin(), sums_.end(), 0.0);
    in_record_ = 0;
    if (pending_bytes_ >= kEnough) flush();
}

void ContributionFiles::add(std::string_view answers) {
    const std::size_t size = sums_.size() * sizeof(double);
    for (std::size_t at = 0; at + size <= answers.size(); at += size) {
        if (writing_.rays == 1) {
            std::memcpy(sums_.data(), answers.data() + at, size);
        } else {
            for (std::size_t k = 0; k < sums_.size(); ++k) {
                double part = 0;
                std::memcpy(&part, answers.data() + at + k * sizeof part, sizeof part);
                sums_[k] += part;
            }
        }
        ++in_record_;
        if (in_record_ == writing_.rays) put_record(1.0 / in_record_);
        if (writing_.rays == 0) in_record_ = 1;
    }
}

void ContributionFiles::flush() {
    for (Target& target : targets_) {
        if (target.part.empty() || target.pending.empty()) continue;
        write_bytes(target.part, target.pending, "ab");
        target.pending.clear();
    }
    pending_bytes_ = 0;
}

std::string ContributionFiles::take_standard_output() {
    std::string bytes;
    for (Target& target : targets_) {
        if (!target.part.empty()) continue;
        if (bytes.empty())
            bytes = std::exchange(target.pending, {});
        else
            bytes += std::exchange(target.pending, {});
    }
    return bytes;
}

bool ContributionFiles::finish() {
    const bool partial = writing_.rays > 0 && in_record_ > 0;
    if (writing_.rays == 0)
        put_record(1);
    else if (partial)
        put_record(1.0 / in_record_);
    flush();
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        if (targets_[i].part.empty() || !targets_[i].renamed) continue;
        std::error_code error;
        fs::rename(targets_[i].part, writing_.outputs[i].file, error);
        if (error) fail(writing_.outputs[i].file, "cannot write", error.value());
    }
    return partial;
}

}  // namespace lightwalk
