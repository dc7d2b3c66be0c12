#pragma once
// How large the frames of a walk are while the view moves.
#include "core/cloud/cloud_frame.h"

namespace lightwalk {

/// Chooses the size of moving frames by what the frames before were like: the largest of which
/// nearly every pixel is reused, traced in time, or inferred from its own surface. A smaller
/// picture is blurred where the large one would be guessed.
class MovingSize {
  public:
    /// Share of the width and of the height that are wished for, 0.35 ... 1.
    [[nodiscard]] double share() const;
    [[nodiscard]] int of(int side) const;
    /// A frame of this size was drawn while the view moved.
    /// @param budget  the time that there was for it [s]
    void record(const CloudReport& report, double budget);

  private:
    void step(int by);

    int step_ = 0;            ///< smaller by so many halvings of the pixels
    bool changed_ = false;    ///< the next frame is the first one of its size, which tells little
    int good_ = 0, bad_ = 0;  ///< frames in a row that call for a larger, or a smaller size
    int patience_ = 8;        ///< good frames until a larger size is tried
    int since_larger_ = 0;    ///< frames since one was; 0: none was
};

}  // namespace lightwalk
