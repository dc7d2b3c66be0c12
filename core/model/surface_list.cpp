#include "core/model/surface_list.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "core/model/primitive.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kCorners = 3;              ///< of a triangle
constexpr std::size_t kTriangle = 3 * kCorners;  ///< reals of a triangle

[[noreturn]] void refuse(const char* what) {
    throw InputError(std::string("damaged surfaces: ") + what);
}

/// Checks one record by itself.
void check_record(const SurfaceRecord& record, const SurfaceList::Columns& columns,
                  std::size_t modifiers, unsigned file_bits) {
    const std::size_t type = record.file_and_type >> file_bits,
                      file = record.file_and_type & ((1U << file_bits) - 1);
    if (type >= primitive_type_count() || !is_surface(static_cast<PrimitiveType>(type)))
        refuse("a type that is none");
    if (file >= columns.files.size()) refuse("a file that is none");
    if (record.name >= columns.text.size()) refuse("a name beyond the text");
    if (record.corners != SurfaceRecord::kOwnCorners &&
        (static_cast<PrimitiveType>(type) != PrimitiveType::polygon ||
         std::size_t{record.corners} + kCorners > columns.corners.size()))
        refuse("corners that are none");
    if (record.modifier < kVoidIndex || record.modifier >= static_cast<std::int64_t>(modifiers))
        refuse("a modifier that is none");
}

/// String arguments are in the order of the surfaces and of the text, so that one pass over the
/// text checks them.
void check_strings(const SurfaceList::Columns& columns) {
    std::size_t surface = 0, at = 0;
    for (const SurfaceStrings& strings : columns.strings) {
        if (strings.surface < surface || strings.surface >= columns.records.size() ||
            strings.text < at)
            refuse("strings of no surface");
        surface = std::size_t{strings.surface} + 1;
        at = strings.text;
        for (std::uint32_t i = 0; i < strings.count; ++i) {
            if (at >= columns.text.size()) refuse("more strings than text");
            at += std::strlen(columns.text.data() + at) + 1;
        }
    }
}

}  // namespace

std::string_view StringArguments::operator[](std::size_t i) const {
    const char* text = first_;
    for (; i > 0; --i) text += std::strlen(text) + 1;
    return text;
}

std::vector<std::string> StringArguments::to_strings() const {
    std::vector<std::string> strings;
    strings.reserve(count_);
    const char* text = first_;
    for (std::size_t i = 0; i < count_; ++i) {
        strings.emplace_back(text);
        text += strings.back().size() + 1;
    }
    return strings;
}

SurfaceList::SurfaceList(Columns columns, std::size_t modifiers) : columns_(std::move(columns)) {
    const Columns& c = columns_;
    if (c.records.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) ||
        c.reals.size() > kMost || c.corners.size() > kMost || c.text.size() > kMost)
        refuse("too many");
    for (const std::uint32_t corner : c.corners)
        if (std::size_t{corner} + 3 > c.reals.size()) refuse("a corner that is none");
    if (!c.text.empty() && c.text.back() != '\0') refuse("text without an end");
    std::uint32_t from = 0;
    for (const SurfaceRecord& record : c.records) {
        check_record(record, c, modifiers, kFileBits);
        if (record.first_real < from || record.first_real > c.reals.size())
            refuse("numbers that are none");
        from = record.first_real;
    }
    check_strings(c);
}

std::uint32_t SurfaceList::file_number(const FileName* file) {
    std::vector<FileName>& files = columns_.files;
    const FileName none;
    const FileName& name = file != nullptr ? *file : none;
    if (files.empty() || !(files.back().is(name) || files.back() == name)) files.push_back(name);
    if (files.size() > std::size_t{1} << kFileBits) throw InputError("too many files in one model");
    return static_cast<std::uint32_t>(files.size() - 1);
}

std::uint32_t SurfaceList::add_text(std::string_view text) {
    const std::size_t at = columns_.text.size();
    if (at + text.size() >= kMost) throw InputError("too many names in one model");
    text = text.substr(0, text.find('\0'));
    columns_.text.append(text);
    columns_.text.push_back('\0');
    return static_cast<std::uint32_t>(at);
}

std::uint32_t SurfaceList::add_reals(const SurfacePrimitive& surface) {
    const RealArguments& reals = surface.reals;
    if (surface.type == PrimitiveType::polygon && reals.size() == kTriangle)
        return add_triangle(reals);
    for (std::size_t i = 0; i < reals.size(); ++i) columns_.reals.push_back(reals[i]);
    return SurfaceRecord::kOwnCorners;
}

/// Stores a triangle that shares corners by indices, which take less memory than numbers; one that
/// shares none is stored directly, as other polygons are.
std::uint32_t SurfaceList::add_triangle(const RealArguments& reals) {
    std::array<double, kTriangle> numbers{};
    for (std::size_t i = 0; i < kTriangle; ++i) numbers[i] = reals[i];
    std::array<std::uint32_t, kCorners> corners{};
    for (std::size_t i = 0; i < kCorners; ++i)
        corners[i] = recent_.find(&numbers[3 * i], columns_.reals.values());
    const bool shares = std::ranges::any_of(
        corners, [](std::uint32_t corner) { return corner != RecentCorners::kNone; });
    for (std::size_t i = 0; i < kCorners; ++i) {
        if (corners[i] != RecentCorners::kNone) continue;
        corners[i] = static_cast<std::uint32_t>(columns_.reals.size());
        columns_.reals.append(std::span(numbers).subspan(3 * i, 3));
        recent_.note(&numbers[3 * i], corners[i]);
    }
    if (!shares) return SurfaceRecord::kOwnCorners;
    const std::size_t place = columns_.corners.size();
    columns_.corners.append(corners);
    return static_cast<std::uint32_t>(place);
}

std::size_t SurfaceList::add_record(const SurfacePrimitive& surface) {
    const std::size_t number = size(), first = columns_.reals.size();
    if (number >= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) ||
        first + surface.reals.size() >= kMost || columns_.corners.size() + kCorners >= kMost)
        throw InputError(surface.where(), "too many surfaces in one model");
    const std::uint32_t file = file_number(surface.file);
    const std::uint32_t corners = add_reals(surface);
    columns_.records.push_back({static_cast<std::uint32_t>(first), corners, add_text(surface.name),
                                surface.modifier, surface.line,
                                static_cast<std::uint32_t>(surface.type) << kFileBits | file});
    return number;
}

std::size_t SurfaceList::add(const SurfacePrimitive& surface) {
    const std::size_t number = add_record(surface);
    if (surface.strings.empty()) return number;
    columns_.strings.push_back({static_cast<std::uint32_t>(number),
                                static_cast<std::uint32_t>(columns_.text.size()),
                                static_cast<std::uint32_t>(surface.strings.size())});
    const char* text = surface.strings.data();
    for (std::size_t i = 0; i < surface.strings.size(); ++i) {
        const std::string_view argument = text;
        (void)add_text(argument);
        text += argument.size() + 1;
    }
    return number;
}

std::size_t SurfaceList::add(const Primitive& surface) {
    std::string text;
    for (const std::string& argument : surface.strings) {
        text.append(argument, 0, argument.find('\0'));
        text.push_back('\0');
    }
    return add({surface.type, surface.modifier, surface.name,
                StringArguments(text.c_str(), surface.strings.size()), surface.reals,
                &surface.where.file, surface.where.line});
}

SurfaceList SurfaceList::own_copy() const {
    SurfaceList copy;
    copy.columns_.records.append(columns_.records.values());
    copy.columns_.reals.append(columns_.reals.values());
    copy.columns_.corners.append(columns_.corners.values());
    copy.columns_.text.append(columns_.text.values());
    copy.columns_.strings.append(columns_.strings.values());
    copy.columns_.files = columns_.files;
    return copy;
}

void SurfaceList::trim() {
    columns_.records.trim();
    columns_.reals.trim();
    columns_.corners.trim();
    recent_.clear();
    columns_.text.trim();
    columns_.strings.trim();
    columns_.files.shrink_to_fit();
}

SurfacePrimitive SurfaceList::operator[](std::size_t i) const {
    const SurfaceRecord& record = columns_.records[i];
    SurfacePrimitive surface{type(i),
                             record.modifier,
                             columns_.text.data() + record.name,
                             {},
                             {},
                             &columns_.files[record.file_and_type & ((1U << kFileBits) - 1)],
                             record.line};
    surface.reals = reals(i);
    const auto* const strings = std::lower_bound(
        columns_.strings.data(), columns_.strings.data() + columns_.strings.size(), i,
        [](const SurfaceStrings& s, std::size_t number) { return s.surface < number; });
    if (strings != columns_.strings.data() + columns_.strings.size() && strings->surface == i)
        surface.strings = {columns_.text.data() + strings->text, strings->count};
    return surface;
}

RealArguments SurfaceList::reals(std::size_t i) const {
    const Columns& c = columns_;
    if (shares_corners(i)) return {c.reals.data(), c.corners.values().subspan(place(i), kCorners)};
    const std::size_t end = i + 1 < size() ? c.records[i + 1].first_real : c.reals.size();
    return c.reals.values().subspan(place(i), end - place(i));
}

std::size_t SurfaceList::own_bytes() const {
    return columns_.records.own_bytes() + columns_.reals.own_bytes() +
           columns_.corners.own_bytes() + columns_.text.own_bytes() + columns_.strings.own_bytes() +
           columns_.files.capacity() * sizeof(FileName);
}

std::size_t SurfaceList::mapped_bytes() const {
    return columns_.records.mapped_bytes() + columns_.reals.mapped_bytes() +
           columns_.corners.mapped_bytes() + columns_.text.mapped_bytes() +
           columns_.strings.mapped_bytes();
}

}  // namespace lightwalk
