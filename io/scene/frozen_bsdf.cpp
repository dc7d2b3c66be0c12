#include "io/scene/frozen_bsdf.h"

#include <algorithm>
#include <cmath>

#include "io/formats/packed.h"

namespace lightwalk {
namespace {

/// How a component is stored.
enum class TableKind : std::uint8_t { none, matrix, tree };

void pack_basis(PackedWriter& writer, const AngleBasis& basis) {
    writer.count(basis.rings().size());
    for (const AngleRing& ring : basis.rings()) {
        writer.number(ring.upper);
        writer.count(ring.sectors);
    }
}

AngleBasis unpack_basis(PackedReader& reader) {
    std::vector<AngleRing> rings(reader.count(2 * sizeof(double)));
    double before = 0;
    for (AngleRing& ring : rings) {
        ring.upper = reader.number<double>();
        ring.sectors = reader.number<std::uint64_t>();
        if (!(ring.upper > before) || !(ring.upper <= 90) || ring.sectors < 1 ||
            ring.sectors > AngleBasis::kMostSectors)
            reader.fail();
        before = ring.upper;
    }
    if (rings.size() > AngleBasis::kMostRings || before != 90) reader.fail();
    return AngleBasis(std::move(rings));
}

void pack_tree(PackedWriter& writer, const TensorTree& tree) {
    writer.number(static_cast<std::uint32_t>(tree.rank()));
    writer.number(tree.root());
    writer.list(tree.nodes());
}

TensorTree unpack_tree(PackedReader& reader) {
    const auto rank = reader.number<std::uint32_t>();
    const auto root = reader.number<TensorTree::Entry>();
    if (rank != 3 && rank != 4) reader.fail();
    TensorTree tree(static_cast<int>(rank), reader.list<TensorTree::Entry>(), root);
    if (!tree.sound()) reader.fail();
    return tree;
}

void pack_table(PackedWriter& writer, const std::optional<BsdfTable>& table) {
    if (!table) {
        writer.number(TableKind::none);
    } else if (const auto* matrix = std::get_if<BsdfMatrix>(&*table)) {
        writer.number(TableKind::matrix);
        pack_basis(writer, matrix->incident);
        pack_basis(writer, matrix->exitant);
        writer.list(matrix->y);
        writer.list(matrix->xz);
    } else {
        const auto& tree = std::get<BsdfTree>(*table);
        writer.number(TableKind::tree);
        writer.boolean(tree.u.has_value());
        pack_tree(writer, tree.y);
        if (tree.u) pack_tree(writer, *tree.u);
        if (tree.v) pack_tree(writer, *tree.v);
    }
}

bool is_value(float x) {
    return x >= 0 && std::isfinite(x);
}

BsdfMatrix unpack_matrix(PackedReader& reader) {
    BsdfMatrix matrix;
    matrix.incident = unpack_basis(reader);
    matrix.exitant = unpack_basis(reader);
    matrix.y = reader.list<float>();
    matrix.xz = reader.list<std::array<float, 2>>();
    const auto values = [](const std::array<float, 2>& xz) {
        return is_value(xz[0]) && is_value(xz[1]);
    };
    if (matrix.y.empty() || matrix.y.size() != matrix.incident.size() * matrix.exitant.size() ||
        (!matrix.xz.empty() && matrix.xz.size() != matrix.y.size()) ||
        !std::ranges::all_of(matrix.y, is_value) || !std::ranges::all_of(matrix.xz, values))
        reader.fail();
    return matrix;
}

BsdfTree unpack_trees(PackedReader& reader) {
    const bool colored = reader.boolean();
    BsdfTree tree{unpack_tree(reader), {}, {}};
    if (colored) {
        tree.u = unpack_tree(reader);
        tree.v = unpack_tree(reader);
        if (tree.u->rank() != tree.y.rank() || tree.v->rank() != tree.y.rank()) reader.fail();
    }
    return tree;
}

std::optional<BsdfTable> unpack_table(PackedReader& reader) {
    switch (reader.number<TableKind>()) {
        case TableKind::none:
            return std::nullopt;
        case TableKind::matrix:
            return unpack_matrix(reader);
        case TableKind::tree:
            return unpack_trees(reader);
    }
    reader.fail();
}

}  // namespace

void freeze_bsdf(const BsdfData& data, std::uint32_t number, FrozenParts& parts) {
    PackedWriter writer;
    writer.text(data.name);
    writer.number(data.size);
    writer.text(data.geometry);
    writer.number(data.geometry_unit);
    writer.number(data.geometry_line);
    for (const std::optional<BsdfTable>& table : data.parts) pack_table(writer, table);
    parts.add(FrozenKind::bsdf, number, writer.bytes());
}

std::shared_ptr<const BsdfData> map_bsdf(const FrozenFile& file, std::uint32_t number) {
    PackedReader reader(part_of(file, FrozenKind::bsdf, number), file.name(), "BSDF data");
    auto data = std::make_shared<BsdfData>();
    data->name = reader.text();
    data->size = reader.number<std::array<double, 3>>();
    data->geometry = reader.text();
    data->geometry_unit = reader.number<double>();
    data->geometry_line = reader.number<std::int32_t>();
    for (std::optional<BsdfTable>& table : data->parts) table = unpack_table(reader);
    reader.end();
    return data;
}

}  // namespace lightwalk
