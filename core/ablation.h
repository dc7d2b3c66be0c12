#pragma once
// Techniques that make rays faster, as switches: to measure what each gains.

namespace lightwalk {

/// What is used to make rays faster. No switch changes a bit of what a ray brings back.
struct Ablation {
    bool batches = true;         ///< rays wait for each other where they need direct light
    bool function_lanes = true;  ///< patterns of light sources: functions of several points at once
    bool sample_lanes = true;    ///< samples of light sources: several at once
    bool leaves = true;          ///< large search trees end in quantised leaves
    bool slices = true;          ///< the search tree holds long cones in slices
    bool packets = true;         ///< coherent rays search the tree in packets

    friend bool operator==(const Ablation&, const Ablation&) = default;
};

}  // namespace lightwalk
