#pragma once
// How far away what a picture shows is, as a piece of a frame: for pages that draw the camera
// between frames.
#include <cstdint>
#include <string>
#include <vector>

#include "core/view/view.h"
#include "parallel/executor.h"
#include "parallel/walk/live_walk.h"

namespace lightwalk {

/// For one thread.
class DepthPiece {
  public:
    /// Keep the distances of a picture.
    /// @param eye_height  which tells how far people go in a moment [m]
    void keep(const LivePicture& picture, const View& view, double eye_height, Executor& executor);
    /// Keep none.
    void forget() { content_ = 0; }
    /// A hash of what is kept; 0: there are no distances, or the view is none that pages can draw.
    [[nodiscard]] std::uint64_t content() const { return content_; }
    /// The piece's bytes; empty where content() is 0.
    [[nodiscard]] const std::string& bytes(Executor& executor);

  private:
    void adapt_step();

    View view_;
    int width_ = 0, height_ = 0;
    std::vector<float> distance_;
    float step_ = 0;
    float coarseness_ = 1;  ///< of the step: pieces would be too large with the finest
    int small_ = 0;         ///< pieces since it changed that were small
    std::uint64_t content_ = 0, coded_ = 0;  ///< coded_: content of the bytes
    std::string bytes_;
};

}  // namespace lightwalk
