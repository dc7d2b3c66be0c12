#pragma once
// The surfaces of a model as they were read, packed: a building has millions of them.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/model/column.h"
#include "core/model/primitive_type.h"
#include "core/model/real_arguments.h"
#include "core/model/shared_corners.h"

namespace lightwalk {

struct Primitive;

/// String arguments of a surface: views of texts that end with a zero byte and lie one behind the
/// other.
class StringArguments {
  public:
    StringArguments() = default;
    StringArguments(const char* first, std::size_t count) : first_(first), count_(count) {}
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    /// Where the first begins.
    [[nodiscard]] const char* data() const { return first_; }
    /// Steps over the strings before it.
    [[nodiscard]] std::string_view operator[](std::size_t i) const;
    [[nodiscard]] std::vector<std::string> to_strings() const;

  private:
    const char* first_ = nullptr;
    std::size_t count_ = 0;
};

/// A view of one surface: it owns nothing.
struct SurfacePrimitive {
    PrimitiveType type{};
    std::int32_t modifier = -1;  ///< into Model::modifiers; kVoidIndex for `void`
    std::string_view name;
    StringArguments strings;
    RealArguments reals;
    const FileName* file = nullptr;  ///< null: none
    std::int32_t line = 0;

    [[nodiscard]] SourceLocation where() const {
        return {file != nullptr ? *file : FileName(), line};
    }
};

/// What a surface weighs beside its text and its numbers.
struct SurfaceRecord {
    static constexpr std::uint32_t kOwnCorners = 0xffffffff;

    std::uint32_t first_real = 0;  ///< its own reals end where those of the next surface begin
    std::uint32_t corners = kOwnCorners;  ///< where those of a triangle begin that shares some
    std::uint32_t name = 0;               ///< where it begins in the text
    std::int32_t modifier = -1;
    std::int32_t line = 0;
    std::uint32_t file_and_type = 0;  ///< the type in the uppermost eight bits
};

/// String arguments of one surface; few surfaces have any.
struct SurfaceStrings {
    std::uint32_t surface = 0;
    std::uint32_t text = 0;  ///< where the first begins in the text
    std::uint32_t count = 0;
};

/// The surfaces of a model in the order of their definitions.
class SurfaceList {
  public:
    /// All that a list holds, as a file keeps it.
    struct Columns {
        Column<SurfaceRecord> records;
        Column<double> reals;
        Column<std::uint32_t> corners;   ///< in threes: where the numbers of each stand in `reals`
        Column<char> text;               ///< names and string arguments, each with a zero byte
        Column<SurfaceStrings> strings;  ///< in the order of the surfaces
        std::vector<FileName> files;
    };

    SurfaceList() = default;
    /// Takes what was stored. Throws InputError where it cannot be what a list has stored.
    /// @param modifiers  how many modifiers the model has
    SurfaceList(Columns columns, std::size_t modifiers);

    /// Add a surface of another list; returns its number. Throws InputError when there are too many
    /// of anything (some 2^31 surfaces, 2^32 reals or bytes of text, 2^24 files).
    std::size_t add(const SurfacePrimitive& surface);
    std::size_t add(const Primitive& surface);
    /// Nothing more comes.
    void trim();

    [[nodiscard]] std::size_t size() const { return columns_.records.size(); }
    [[nodiscard]] bool empty() const { return size() == 0; }
    [[nodiscard]] SurfacePrimitive operator[](std::size_t i) const;
    [[nodiscard]] PrimitiveType type(std::size_t i) const {
        return static_cast<PrimitiveType>(columns_.records[i].file_and_type >> kFileBits);
    }
    [[nodiscard]] std::int32_t modifier(std::size_t i) const {
        return columns_.records[i].modifier;
    }
    /// Whether surface i is a triangle whose corners are places in `reals`, and not all its own.
    [[nodiscard]] bool shares_corners(std::size_t i) const {
        return columns_.records[i].corners != SurfaceRecord::kOwnCorners;
    }
    /// Where the reals of surface i begin in `reals`; those of a triangle that shares corners, in
    /// `corners`.
    [[nodiscard]] std::uint32_t place(std::size_t i) const {
        const SurfaceRecord& record = columns_.records[i];
        return shares_corners(i) ? record.corners : record.first_real;
    }
    [[nodiscard]] RealArguments reals(std::size_t i) const;
    [[nodiscard]] const Columns& columns() const { return columns_; }
    /// In the process's own memory.
    [[nodiscard]] std::size_t own_bytes() const;
    /// In a file that is mapped.
    [[nodiscard]] std::size_t mapped_bytes() const;

  private:
    static constexpr unsigned kFileBits = 24;

    std::uint32_t file_number(const FileName* file);
    std::uint32_t add_text(std::string_view text);
    std::size_t add_record(const SurfacePrimitive& surface);
    // These return where the places of its corners begin, if any.
    std::uint32_t add_reals(const SurfacePrimitive& surface);
    std::uint32_t add_triangle(const RealArguments& reals);

    Columns columns_;
    RecentCorners recent_;  ///< until nothing more comes
};

}  // namespace lightwalk
