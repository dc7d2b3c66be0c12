#include "io/scene/binary_objects.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/model/transform_args.h"

namespace lightwalk {
namespace {

constexpr int kLargestLeaf = 511;
constexpr std::size_t kTypeNumbers = 128;  ///< a type is a signed byte, and negative means the end

struct TypeTable {
    std::vector<std::string> words;
    std::vector<std::optional<PrimitiveType>> types;
};

TypeTable read_type_table(BinaryReader& reader) {
    TypeTable table;
    for (std::string word = reader.string(); !word.empty(); word = reader.string()) {
        if (table.words.size() == kTypeNumbers) continue;  // no object can name what follows
        table.types.push_back(primitive_type(word));
        table.words.push_back(std::move(word));
    }
    return table;
}

PrimitiveType type_of(BinaryReader& reader, const TypeTable& table, std::int64_t number) {
    const auto at = static_cast<std::size_t>(number);
    if (number < 0 || at >= table.types.size()) {
        reader.fail("reference to unknown type number " + std::to_string(number));
    }
    if (!table.types[at]) reader.fail("reference to unknown type \"" + table.words[at] + "\"");
    return *table.types[at];
}

/// Maps object numbers of the file to the model, which numbers modifiers and surfaces separately.
class ObjectNumbers {
  public:
    [[nodiscard]] std::size_t size() const { return modifiers_.size(); }
    /// @param object  less than size(), or -1 for `void`
    /// Throws InputError when it is a surface.
    [[nodiscard]] std::int32_t modifier(std::int64_t object, const Model& model,
                                        const BinaryReader& reader) const {
        if (object < 0) return kVoidIndex;
        const std::int32_t number = modifiers_[static_cast<std::size_t>(object)];
        if (number >= 0) return number;
        const SurfacePrimitive surface = model.surfaces[static_cast<std::size_t>(-1 - number)];
        reader.fail("a surface cannot be a modifier: " + std::string(to_string(surface.type)) +
                    " \"" + std::string(surface.name) + "\"");
    }
    void add(bool is_surface, std::int32_t number) {
        modifiers_.push_back(is_surface ? -1 - number : number);
    }

  private:
    std::vector<std::int32_t> modifiers_;  ///< by object; of surface i: -1 - i
};

/// An alias without a string renames its modifier; with one it is an alias of the scene language.
std::int32_t add_modifier(ModelBuilder& builder, Primitive object) {
    if (object.type != PrimitiveType::alias) return builder.add(std::move(object));
    if (object.strings.empty()) return builder.rename(object.name, object.modifier, object.where);
    const std::int32_t target = builder.alias_target(object.strings[0], object.where);
    return builder.add_alias(object.modifier, object.name, target, object.where);
}

/// Objects of one file, one after the other.
class ObjectReader {
  public:
    ObjectReader(BinaryReader& reader, int id_size, ModelBuilder& builder)
        : reader_(reader), id_size_(id_size), builder_(builder), file_(reader.name()) {}

    void read(PrimitiveType type) {
        const std::int32_t modifier = read_modifier();
        const std::string_view name = reader_.text();
        const std::uint64_t strings = reader_.unsigned_integer(2);
        reader_.expect(strings, 1);
        // Where they stand in the bytes, each with its zero byte, is how surfaces take them.
        const char* first = nullptr;
        for (std::uint64_t i = 0; i < strings; ++i) {
            const char* const string = reader_.text().data();
            if (i == 0) first = string;
        }
        read_reals();
        const StringArguments arguments(first, strings);
        if (is_surface(type)) {
            numbers_.add(true, builder_.add(SurfacePrimitive{type, modifier, name, arguments,
                                                             reals_, &file_, 0}));
            return;
        }
        Primitive object;
        object.type = type;
        object.where = {file_, 0};
        object.modifier = modifier;
        object.name = name;
        object.strings = arguments.to_strings();
        object.reals = reals_;
        numbers_.add(false, add_modifier(builder_, std::move(object)));
    }

  private:
    [[nodiscard]] std::int32_t read_modifier() {
        const std::int64_t modifier = reader_.integer(id_size_);
        if (modifier < -1 || modifier >= static_cast<std::int64_t>(numbers_.size())) {
            reader_.fail("object " + std::to_string(numbers_.size()) + " has modifier number " +
                         std::to_string(modifier) + ", expected that of an earlier object");
        }
        return numbers_.modifier(modifier, builder_.model(), reader_);
    }

    void read_reals() {
        const std::uint64_t reals = reader_.unsigned_integer(2);
        reader_.expect(reals, 5);
        reals_.clear();
        for (std::uint64_t i = 0; i < reals; ++i) reals_.push_back(reader_.real());
    }

    BinaryReader& reader_;
    int id_size_;
    ModelBuilder& builder_;
    FileName file_;
    ObjectNumbers numbers_;
    std::vector<double> reals_;  ///< numbers of one object; the memory is reused
};

}  // namespace

ModelCube read_cube(BinaryReader& reader) {
    double values[4] = {};
    for (double& value : values) {
        const std::string text = reader.string();
        if (!parse_real(text, value))
            reader.fail("bad bounding cube: \"" + text + "\" is no number");
    }
    return {values[0], values[1], values[2], values[3]};
}

std::uint64_t skip_tree(BinaryReader& reader, int id_size) {
    std::uint64_t nodes = 0;
    for (std::uint64_t open = 1; open > 0; ++nodes) {
        switch (reader.unsigned_integer(1)) {
            case 0:
                --open;
                break;
            case 1: {
                const std::int64_t count = reader.integer(id_size);
                if (count < 1 || count > kLargestLeaf) {
                    reader.fail("damaged tree: a leaf of " + std::to_string(count) + " objects");
                }
                reader.skip(static_cast<std::uint64_t>(count * id_size));
                --open;
                break;
            }
            case 2:
                open += 7;
                break;
            default:
                reader.fail("damaged tree: unknown node tag");
        }
    }
    return nodes;
}

void read_objects(BinaryReader& reader, int id_size, ModelBuilder& builder) {
    const TypeTable table = read_type_table(reader);
    ObjectReader objects(reader, id_size, builder);
    for (std::int64_t type = reader.integer(1); type != -1; type = reader.integer(1))
        objects.read(type_of(reader, table, type));
}

}  // namespace lightwalk
