#include "io/bsdf/bsdf_file.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/model/transform_args.h"
#include "io/bsdf/angle_basis_text.h"
#include "io/bsdf/tree_text.h"
#include "io/bsdf/xml_text.h"

namespace lightwalk {
namespace {

using pugi::xml_node;

/// What a block of values is: luminance, or one of two numbers for the colour.
enum class Quantity : std::uint8_t { luminance, first_color, second_color };
constexpr std::size_t kQuantities = 3;

std::optional<Quantity> quantity_of(std::string_view wavelength, bool tree) {
    using enum Quantity;
    if (same_word(wavelength, "Visible")) return luminance;
    if (same_word(wavelength, tree ? "CIE-u" : "CIE-X")) return first_color;
    if (same_word(wavelength, tree ? "CIE-v" : "CIE-Z")) return second_color;
    return std::nullopt;
}

std::optional<BsdfPart> part_of(std::string_view direction) {
    using enum BsdfPart;
    if (same_word(direction, "Transmission Back")) return front_transmission;
    if (same_word(direction, "Transmission Front")) return back_transmission;
    if (same_word(direction, "Reflection Back")) return front_reflection;
    if (same_word(direction, "Reflection Front")) return back_reflection;
    return std::nullopt;
}

/// A block of values of a matrix.
struct MatrixBlock {
    AngleBasis incident, exitant;
    std::vector<float> values;  ///< [incident * exitant + exitant]
};

/// The blocks of each component, by quantity.
template <class Block>
using Blocks = std::array<std::array<std::optional<Block>, kQuantities>, kBsdfParts>;

class BsdfReader {
  public:
    BsdfReader(std::string_view bytes, const std::string& name) : document_(bytes, name) {}
    BsdfData read();

  private:
    void read_material(const xml_node& material);
    void read_geometry(const xml_node& geometry);
    [[nodiscard]] double length_of(const xml_node& element) const;
    template <class Block, class Read>
    [[nodiscard]] Blocks<Block> read_blocks(const xml_node& layer, bool tree, const Read& read);
    void read_matrices(const xml_node& layer, const xml_node& definition, bool rows);
    void read_trees(const xml_node& layer, int rank);
    [[nodiscard]] MatrixBlock read_matrix(const xml_node& block, const NamedBases& bases,
                                          bool rows) const;
    [[nodiscard]] std::vector<float> read_values(XmlNumbers& numbers, MatrixBlock& matrix) const;

    XmlText document_;
    BsdfData data_;
};

BsdfData BsdfReader::read() {
    const xml_node root = document_.root();
    if (std::string_view(root.name()) != "WindowElement")
        throw document_.error(root, "the root of a BSDF file is not WindowElement");
    const xml_node type = root.child("FileType");
    if (type && !same_word(trimmed_text(type), "BSDF"))
        throw document_.error(type, "FileType is not BSDF");
    const xml_node layer = root.child("Optical").child("Layer");
    if (!layer) throw document_.error(root, "no Optical layer");
    const xml_node definition = layer.child("DataDefinition");
    const xml_node structure = definition.child("IncidentDataStructure");
    if (!structure) throw document_.error(layer, "no IncidentDataStructure");
    read_material(layer.child("Material"));
    read_geometry(layer.child("Geometry"));
    const std::string_view kind = trimmed_text(structure);
    if (same_word(kind, "Columns") || same_word(kind, "Rows"))
        read_matrices(layer, definition, same_word(kind, "Rows"));
    else if (same_word(kind, "TensorTree3") || same_word(kind, "TensorTree4"))
        read_trees(layer, kind.back() - '0');
    else
        throw document_.error(structure, "unknown IncidentDataStructure");
    for (const auto& part : data_.parts) {
        if (part) return std::move(data_);
    }
    throw document_.error(layer, "no visible data");
}

void BsdfReader::read_material(const xml_node& material) {
    data_.name = trimmed_text(material.child("Name"));
    data_.size = {length_of(material.child("Width")), length_of(material.child("Height")),
                  length_of(material.child("Thickness"))};
}

void BsdfReader::read_geometry(const xml_node& geometry) {
    if (!geometry || !same_word(geometry.attribute("format").value(), "MGF")) return;
    const xml_node block = geometry.child("MGFblock");
    const std::string_view text = trimmed_text(block);
    data_.geometry = text;
    if (!text.empty()) {
        const pugi::xml_text all = block.text();
        data_.geometry_line = document_.line(all.data().offset_debug() + (text.data() - all.get()));
    }
    data_.geometry_unit = 1;
    const std::string_view unit = block.attribute("unit").value();
    for (const auto& [name, size] :
         {std::pair("Meter", 1.0), std::pair("Foot", 0.3048), std::pair("Inch", 0.0254),
          std::pair("Centimeter", 0.01), std::pair("Millimeter", 0.001)}) {
        if (same_word(unit, name)) data_.geometry_unit = size;
    }
}

/// In metres; 0 where there is none.
double BsdfReader::length_of(const xml_node& element) const {
    double value = 0;
    const std::string_view text = trimmed_text(element);
    if (text.empty()) return 0;
    if (!parse_real(text, value) || !std::isfinite(value) || value < 0)
        throw document_.error(element, std::string(element.name()) + " is no length");
    const std::string_view unit = element.attribute("unit").value();
    if (unit.empty()) return value;
    for (const auto& [name, size] :
         {std::pair("Meter", 1.0), std::pair("Foot", 0.3048), std::pair("Inch", 0.0254),
          std::pair("Centimeter", 0.01), std::pair("Millimeter", 0.001)}) {
        if (same_word(unit, name)) return value * size;
    }
    throw document_.error(element, "unknown unit \"" + std::string(unit.substr(0, 40)) + "\"");
}

/// @param read  Block(element WavelengthDataBlock)
template <class Block, class Read>
Blocks<Block> BsdfReader::read_blocks(const xml_node& layer, bool tree, const Read& read) {
    Blocks<Block> blocks;
    for (const xml_node data : layer.children("WavelengthData")) {
        const auto quantity = quantity_of(trimmed_text(data.child("Wavelength")), tree);
        if (!quantity) continue;
        for (const xml_node block : data.children("WavelengthDataBlock")) {
            const auto part = part_of(trimmed_text(block.child("WavelengthDataDirection")));
            if (!part) continue;
            if (!block.child("ScatteringData"))
                throw document_.error(block, "WavelengthDataBlock without ScatteringData");
            blocks[static_cast<std::size_t>(*part)][static_cast<std::size_t>(*quantity)] =
                read(block);
        }
    }
    return blocks;
}

void BsdfReader::read_matrices(const xml_node& layer, const xml_node& definition, bool rows) {
    const NamedBases bases(document_, definition);
    Blocks<MatrixBlock> blocks = read_blocks<MatrixBlock>(
        layer, false, [&](const xml_node& block) { return read_matrix(block, bases, rows); });
    for (std::size_t part = 0; part < kBsdfParts; ++part) {
        auto& [y, x, z] = blocks[part];
        if (!y) continue;
        BsdfMatrix matrix{std::move(y->incident), std::move(y->exitant), std::move(y->values), {}};
        if (x && z) {
            if (x->values.size() != matrix.y.size() || z->values.size() != matrix.y.size())
                throw document_.error(layer, "matrices of CIE-X, CIE-Z and Visible differ in size");
            matrix.xz.resize(matrix.y.size());
            for (std::size_t i = 0; i < matrix.y.size(); ++i) {
                if (matrix.y[i] > 0)
                    matrix.xz[i] = {x->values[i] / matrix.y[i], z->values[i] / matrix.y[i]};
            }
        }
        data_.parts[part] = std::move(matrix);
    }
}

MatrixBlock BsdfReader::read_matrix(const xml_node& block, const NamedBases& bases,
                                    bool rows) const {
    const xml_node columns = block.child("ColumnAngleBasis"), exits = block.child("RowAngleBasis");
    if (!columns || !exits)
        throw document_.error(block, "WavelengthDataBlock without ColumnAngleBasis, RowAngleBasis");
    MatrixBlock matrix{bases.find(document_, columns), bases.find(document_, exits), {}};
    XmlNumbers numbers(document_, block.child("ScatteringData"));
    const std::vector<float> values = read_values(numbers, matrix);
    const std::size_t incident = matrix.incident.size(), exitant = matrix.exitant.size();
    if (rows) {
        matrix.values = values;
        return matrix;
    }
    matrix.values = std::vector<float>(values.size());
    for (std::size_t o = 0; o < exitant; ++o) {
        for (std::size_t i = 0; i < incident; ++i)
            matrix.values[i * exitant + o] = values[o * incident + i];
    }
    return matrix;
}

/// As many values as the bases want; fewer where these are the half bases of older files, which the
/// matrix gets then.
std::vector<float> BsdfReader::read_values(XmlNumbers& numbers, MatrixBlock& matrix) const {
    const std::size_t wanted = matrix.incident.size() * matrix.exitant.size();
    const std::size_t half = klems_basis("LBNL/Klems Half")->size();
    std::vector<float> values;
    values.reserve(std::min(wanted, numbers.most_left()));
    while (values.size() < wanted && numbers.next() == XmlNumbers::Token::number)
        values.push_back(static_cast<float>(std::max(0.0, numbers.value())));
    if (values.size() == wanted) return values;
    const AngleBasis old = old_klems_half_basis();
    MatrixBlock older = matrix;
    for (AngleBasis* basis : {&older.incident, &older.exitant}) {
        if (basis->size() == half) *basis = old;
    }
    if (numbers.last() != XmlNumbers::Token::end ||
        values.size() != older.incident.size() * older.exitant.size()) {
        throw numbers.error("too few values: " + std::to_string(values.size()) + ", expected " +
                            std::to_string(wanted));
    }
    matrix = std::move(older);
    return values;
}

void BsdfReader::read_trees(const xml_node& layer, int rank) {
    Blocks<TensorTree> blocks = read_blocks<TensorTree>(layer, true, [&](const xml_node& block) {
        const xml_node basis = block.child("AngleBasis");
        if (basis && !same_word(trimmed_text(basis), "LBNL/Shirley-Chiu"))
            throw document_.error(basis, "the AngleBasis of a tree is not LBNL/Shirley-Chiu");
        XmlNumbers numbers(document_, block.child("ScatteringData"));
        return read_tree(rank, numbers);
    });
    for (std::size_t part = 0; part < kBsdfParts; ++part) {
        auto& [y, u, v] = blocks[part];
        if (!y) continue;
        BsdfTree tree{*std::move(y), {}, {}};
        if (u && v) {
            tree.u = std::move(u);
            tree.v = std::move(v);
        }
        data_.parts[part] = std::move(tree);
    }
}

}  // namespace

BsdfData decode_bsdf(std::string_view bytes, const std::string& name) {
    return BsdfReader(bytes, name).read();
}

}  // namespace lightwalk
