#pragma once
// Reads the values of a glTF accessor, sparse ones too, within the bounds of its buffers.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "io/gltf/tiny_gltf.h"

namespace lightwalk {

class GltfAccessor {
  public:
    /// @param components  of each element that are wanted
    /// Throws InputError "NAME: accessor INDEX ...".
    GltfAccessor(const tinygltf::Model& model, int index, std::size_t components,
                 const std::string& name);

    [[nodiscard]] std::size_t size() const { return count_; }
    /// The number of elements that a sparse part replaces.
    [[nodiscard]] std::size_t replaced() const { return replaced_.size(); }
    /// Component c of element i; normalized integers are divided by the largest. Throws InputError
    /// for what is no finite number.
    [[nodiscard]] double at(std::size_t i, std::size_t c) const;
    /// Element i of an accessor of unsigned integers.
    [[nodiscard]] std::uint32_t index(std::size_t i) const;

  private:
    /// `count` elements in a view.
    struct Elements {
        std::string_view bytes;
        std::size_t stride = 0;
    };
    [[nodiscard]] Elements elements(int view, std::size_t offset, std::size_t size,
                                    std::size_t count) const;
    void read_sparse(const tinygltf::Accessor& accessor);
    [[nodiscard]] const char* element(std::size_t i) const;
    [[nodiscard]] InputError error(const std::string& problem) const;

    const tinygltf::Model& model_;
    std::string name_;
    int index_;
    int type_ = 0;  ///< of components
    bool normalized_ = false;
    std::size_t count_ = 0, component_size_ = 0, element_size_ = 0;
    Elements all_, sparse_;
    std::vector<std::uint32_t> replaced_;  ///< whose elements are in sparse_; ascending
};

}  // namespace lightwalk
