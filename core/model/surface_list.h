#pragma once
// The surfaces of a model as they were read, in packed form: a building has millions of them.
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

/// String arguments of a surface: consecutive zero-terminated texts, which it does not own.
class StringArguments {
  public:
    StringArguments() = default;
    StringArguments(const char* first, std::size_t count) : first_(first), count_(count) {}
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    /// The beginning of the first string.
    [[nodiscard]] const char* data() const { return first_; }
    /// String i. Takes time proportional to the strings before it.
    [[nodiscard]] std::string_view operator[](std::size_t i) const;
    [[nodiscard]] std::vector<std::string> to_strings() const;

  private:
    const char* first_ = nullptr;
    std::size_t count_ = 0;
};

/// One surface: a view into a SurfaceList.
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

/// The fixed-size part of a surface, beside its texts and numbers.
struct SurfaceRecord {
    static constexpr std::uint32_t kOwnCorners = 0xffffffff;

    std::uint32_t first_real =
        0;  ///< index of its first real; its reals end where those of the next surface begin
    std::uint32_t corners = kOwnCorners;  ///< for a triangle that shares corners: index of its
                                          ///< three entries in `corners`
    std::uint32_t name = 0;               ///< index of its first character in the text
    std::int32_t modifier = -1;
    std::int32_t line = 0;
    std::uint32_t file_and_type = 0;  ///< the type in the uppermost eight bits
};

/// String arguments of one surface; few surfaces have any.
struct SurfaceStrings {
    std::uint32_t surface = 0;
    std::uint32_t text = 0;  ///< index of the first string in the text
    std::uint32_t count = 0;
};

/// The surfaces of a model in the order of their definitions.
class SurfaceList {
  public:
    /// The contents of a list in columns (structure of arrays), as files store them.
    struct Columns {
        Column<SurfaceRecord> records;
        Column<double> reals;
        Column<std::uint32_t>
            corners;        ///< in threes: index in `reals` of each corner of a triangle
        Column<char> text;  ///< names and string arguments, each with a zero byte
        Column<SurfaceStrings> strings;  ///< in the order of the surfaces
        std::vector<FileName> files;
    };

    SurfaceList() = default;
    /// Takes columns that were read from a file. Throws InputError where they are inconsistent.
    /// @param modifiers  how many modifiers the model has
    SurfaceList(Columns columns, std::size_t modifiers);

    /// Add a surface of another list; returns its number. Throws InputError when there are too many
    /// of anything (some 2^31 surfaces, 2^32 reals or bytes of text, 2^24 files).
    std::size_t add(const SurfacePrimitive& surface);
    std::size_t add(const Primitive& surface);
    /// The same surfaces in the process's own memory, where more can be added.
    [[nodiscard]] SurfaceList own_copy() const;
    /// To be called after the last add(): frees what is only needed while the list grows.
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
    /// Whether surface i is a triangle whose corners are given by indices, because it shares some
    /// with others.
    [[nodiscard]] bool shares_corners(std::size_t i) const {
        return columns_.records[i].corners != SurfaceRecord::kOwnCorners;
    }
    /// Index of the first real of surface i in `reals`; for a triangle that shares corners, of its
    /// first entry in `corners`.
    [[nodiscard]] std::uint32_t place(std::size_t i) const {
        const SurfaceRecord& record = columns_.records[i];
        return shares_corners(i) ? record.corners : record.first_real;
    }
    [[nodiscard]] RealArguments reals(std::size_t i) const;
    [[nodiscard]] const Columns& columns() const { return columns_; }
    /// Bytes in the process's own memory.
    [[nodiscard]] std::size_t own_bytes() const;
    /// Bytes in a mapped file.
    [[nodiscard]] std::size_t mapped_bytes() const;

  private:
    static constexpr unsigned kFileBits = 24;

    std::uint32_t file_number(const FileName* file);
    std::uint32_t add_text(std::string_view text);
    std::size_t add_record(const SurfacePrimitive& surface);
    // These return the index in `corners` of a triangle that shares corners, else kOwnCorners.
    std::uint32_t add_reals(const SurfacePrimitive& surface);
    std::uint32_t add_triangle(const RealArguments& reals);

    Columns columns_;
    RecentCorners recent_;  ///< until trim()
};

}  // namespace lightwalk
