#pragma once
// States of a walk, for those who draw it and those who show it.

namespace lightwalk {

/// When indirect light is traced.
enum class WalkAmbient {
    off,
    rest,  ///< while the view rests
    always,
};

/// What is being done to the picture.
enum class WalkPhase {
    moving,    ///< the view is new
    filling,   ///< pixels that were guessed or carried on are traced
    ambient,   ///< indirect light is added
    refining,  ///< edges get more rays
    done,      ///< it is as good as it gets
};

}  // namespace lightwalk
