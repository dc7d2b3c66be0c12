#include "io/gltf/gltf_accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/gltf/gltf_parts.h"

namespace lightwalk {
namespace {

constexpr double kLargestNumber = 1e20;

/// [bytes]; 0 for unknown types.
std::size_t size_of_component(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

template <class T>
T component(const char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

template <class T>
double integer_component(const char* from, bool normalized) {
    const auto value = static_cast<double>(component<T>(from));
    return normalized ? std::max(value / std::numeric_limits<T>::max(), -1.0) : value;
}

}  // namespace

InputError GltfAccessor::error(const std::string& problem) const {
    return {{name_, 0}, "accessor " + std::to_string(index_) + " " + problem};
}

GltfAccessor::GltfAccessor(const tinygltf::Model& model, int index, std::size_t components,
                           const std::string& name)
    : model_(model), name_(name), index_(index) {
    if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size())
        throw error("does not exist, there are " + std::to_string(model.accessors.size()));
    const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
    type_ = accessor.componentType;
    normalized_ = accessor.normalized;
    count_ = accessor.count;
    component_size_ = size_of_component(type_);
    const int held = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (component_size_ == 0 || held < static_cast<int>(components) || held > 4)
        throw error("is not of the type that its use expects");
    element_size_ = component_size_ * static_cast<std::size_t>(held);
    if (accessor.bufferView < 0) throw error("has no bufferView");
    all_ = elements(accessor.bufferView, accessor.byteOffset, element_size_, count_);
    if (accessor.sparse.isSparse) read_sparse(accessor);
}

GltfAccessor::Elements GltfAccessor::elements(int view, std::size_t offset, std::size_t size,
                                              std::size_t count) const {
    Elements result;
    result.bytes = gltf_view(model_, view, name_);
    const std::size_t stride = model_.bufferViews[static_cast<std::size_t>(view)].byteStride;
    result.stride = stride == 0 ? size : stride;
    const std::size_t available = result.bytes.size();
    if (offset > available) throw error("begins beyond its bufferView");
    result.bytes.remove_prefix(offset);
    if (count == 0) return result;
    if (result.bytes.size() < size || (result.bytes.size() - size) / result.stride < count - 1)
        throw error("has " + std::to_string(count) + " elements, which its bufferView of " +
                    std::to_string(available) + " bytes does not hold");
    return result;
}

void GltfAccessor::read_sparse(const tinygltf::Accessor& accessor) {
    const auto& sparse = accessor.sparse;
    const std::size_t size = size_of_component(sparse.indices.componentType);
    const bool is_unsigned =
        sparse.indices.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
        sparse.indices.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
        sparse.indices.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (sparse.count < 0 || !is_unsigned || sparse.indices.byteOffset < 0 ||
        sparse.values.byteOffset < 0)
        throw error("has a damaged sparse part");
    const auto count = static_cast<std::size_t>(sparse.count);
    const Elements indices =
        elements(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                 size, count);
    sparse_ = elements(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                       element_size_, count);
    for (std::size_t i = 0; i < count; ++i) {
        const char* at = indices.bytes.data() + i * indices.stride;
        const std::uint32_t value = size == 1   ? component<std::uint8_t>(at)
                                    : size == 2 ? component<std::uint16_t>(at)
                                                : component<std::uint32_t>(at);
        if (value >= count_ || (!replaced_.empty() && value <= replaced_.back()))
            throw error("has sparse indices that do not ascend, or beyond its elements");
        replaced_.push_back(value);
    }
}

const char* GltfAccessor::element(std::size_t i) const {
    if (!replaced_.empty()) {
        const auto found = std::lower_bound(replaced_.begin(), replaced_.end(), i);
        if (found != replaced_.end() && *found == i)
            return sparse_.bytes.data() +
                   static_cast<std::size_t>(found - replaced_.begin()) * sparse_.stride;
    }
    return all_.bytes.data() + i * all_.stride;
}

double GltfAccessor::at(std::size_t i, std::size_t c) const {
    const char* from = element(i) + c * component_size_;
    switch (type_) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return integer_component<std::int8_t>(from, normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return integer_component<std::uint8_t>(from, normalized_);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return integer_component<std::int16_t>(from, normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return integer_component<std::uint16_t>(from, normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return integer_component<std::uint32_t>(from, normalized_);
        default:
            break;
    }
    const auto value = static_cast<double>(component<float>(from));
    if (!(std::abs(value) <= kLargestNumber))
        throw error("holds what is no finite number, or too large a one, as element " +
                    std::to_string(i));
    return value;
}

std::uint32_t GltfAccessor::index(std::size_t i) const {
    const char* from = element(i);
    switch (type_) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return component<std::uint8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return component<std::uint16_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return component<std::uint32_t>(from);
        default:
            throw error("is not of unsigned integers, as indices are");
    }
}

}  // namespace lightwalk
