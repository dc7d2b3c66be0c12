#include "core/geometry/embree_leaves.h"

#include <atomic>
#include <functional>
#include <memory>
#include <numeric>
#include <span>

namespace lightwalk {
namespace {

struct ReleaseBvh {
    void operator()(RTCBVHTy* bvh) const noexcept { rtcReleaseBVH(bvh); }
};

/// The boxes as input of Embree's builder, which sorts them so that those of a leaf are
/// consecutive.
class Boxes {
  public:
    Boxes(const BvhPrimitives& bvh_primitives, const ModelPrimitives& model,
          const SearchSpace& space, const TaskRunner& task_runner);
    /// Run the builder; false where it has failed.
    bool divide(RTCDevice device);

    [[nodiscard]] std::size_t size() const { return all_.size(); }
    [[nodiscard]] bool ends_leaf(std::size_t i) const { return all_[i].geomID == kEnd; }
    /// The leaf that ends with box i.
    [[nodiscard]] std::span<const RTCBuildPrimitive> leaf(std::size_t i) const {
        std::size_t first = i;
        while (first > 0 && !ends_leaf(first - 1)) --first;
        return std::span(all_).subspan(first, i + 1 - first);
    }

  private:
    static constexpr unsigned kInside = 0,
                              kEnd = 1;  ///< stored in geomID, which the builder does not change:
                                         ///< whether a box is the last of its leaf
    void mark(const RTCBuildPrimitive* leaf, std::size_t count);

    std::vector<RTCBuildPrimitive> all_;
    std::atomic<std::size_t> marked_{0};  ///< number of boxes in leaves, which several threads make
};

Boxes::Boxes(const BvhPrimitives& bvh_primitives, const ModelPrimitives& model,
             const SearchSpace& space, const TaskRunner& task_runner)
    : all_(bvh_primitives.size()) {
    for_each_part(task_runner, all_.size(), [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const RTCBounds b = rounded(space.box(bvh_primitives.box(i, model)));
            all_[i] = {b.lower_x, b.lower_y, b.lower_z, kInside,
                       b.upper_x, b.upper_y, b.upper_z, static_cast<unsigned>(i)};
        }
    });
    std::erase_if(all_, [](const RTCBuildPrimitive& box) {  // NaN: no ray can hit it
        return !(box.lower_x <= box.upper_x && box.lower_y <= box.upper_y &&
                 box.lower_z <= box.upper_z);
    });
}

/// The cost of a leaf does not depend on its number of boxes (up to eight), as all are tested at
/// once. Of the tree only its leaves are kept.
bool Boxes::divide(RTCDevice device) {
    const std::unique_ptr<RTCBVHTy, ReleaseBvh> bvh(rtcNewBVH(device));
    RTCBuildArguments build = rtcDefaultBuildArguments();
    build.bvh = bvh.get();
    build.maxBranchingFactor = 2;
    build.maxDepth = 64;
    build.sahBlockSize = build.maxLeafSize = kLeafSize;
    build.primitives = all_.data();
    build.primitiveCount = build.primitiveArrayCapacity = all_.size();
    build.userPtr = this;
    build.createNode = [](RTCThreadLocalAllocator, unsigned, void* boxes) { return boxes; };
    build.setNodeChildren = [](void*, void**, unsigned, void*) {};
    build.setNodeBounds = [](void*, const RTCBounds**, unsigned, void*) {};
    build.createLeaf = [](RTCThreadLocalAllocator, const RTCBuildPrimitive* leaf, std::size_t count,
                          void* boxes) {
        static_cast<Boxes*>(boxes)->mark(leaf, count);
        return boxes;
    };
    rtcBuildBVH(&build);
    return marked_ == all_.size();
}

void Boxes::mark(const RTCBuildPrimitive* leaf, std::size_t count) {
    const std::less_equal<>
        no_later;  // total order, also for pointers outside the array: then no box is marked
    const RTCBuildPrimitive *const begin = all_.data(), *const end = begin + all_.size();
    if (!(no_later(begin, leaf) && no_later(leaf + count, end))) return;
    all_[static_cast<std::size_t>(leaf - begin) + count - 1].geomID = kEnd;
    marked_.fetch_add(count, std::memory_order_relaxed);
}

Bounds bounds_of(const RTCBuildPrimitive& box) {
    return {{static_cast<double>(box.lower_x), static_cast<double>(box.lower_y),
             static_cast<double>(box.lower_z)},
            {static_cast<double>(box.upper_x), static_cast<double>(box.upper_y),
             static_cast<double>(box.upper_z)}};
}

QuantizedLeaf quantized_leaf_of(std::span<const RTCBuildPrimitive> leaf,
                                const BvhPrimitives& bvh_primitives) {
    std::array<Bounds, kLeafSize> boxes;
    std::array<PrimitiveRange, kLeafSize> refs;
    for (std::size_t i = 0; i < leaf.size(); ++i) {
        boxes[i] = bounds_of(leaf[i]);
        refs[i] = {bvh_primitives.primitive(leaf[i].primID), bvh_primitives.count(leaf[i].primID)};
    }
    return quantized_leaf({boxes.data(), leaf.size()}, {refs.data(), leaf.size()});
}

}  // namespace

std::vector<QuantizedLeaf> make_quantized_leaves(const BvhPrimitives& bvh_primitives,
                                                 const ModelPrimitives& model,
                                                 const SearchSpace& space, RTCDevice device,
                                                 const TaskRunner& task_runner) {
    Boxes boxes(bvh_primitives, model, space, task_runner);
    if (!boxes.divide(device)) return {};
    std::vector<std::size_t> before(part_count(boxes.size()) + 1, 0);
    for_each_part(task_runner, boxes.size(),
                  [&](std::size_t part, std::size_t first, std::size_t last) {
                      std::size_t leaves = 0;
                      for (std::size_t i = first; i < last; ++i)
                          leaves += boxes.ends_leaf(i) ? 1 : 0;
                      before[part + 1] = leaves;
                  });
    std::partial_sum(before.begin(), before.end(), before.begin());
    std::vector<QuantizedLeaf> leaves(before.back());
    for_each_part(task_runner, boxes.size(),
                  [&](std::size_t part, std::size_t first, std::size_t last) {
                      std::size_t next = before[part];
                      for (std::size_t i = first; i < last; ++i)
                          if (boxes.ends_leaf(i))
                              leaves[next++] = quantized_leaf_of(boxes.leaf(i), bvh_primitives);
                  });
    return leaves;
}

}  // namespace lightwalk
