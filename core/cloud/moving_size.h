#pragma once
// How large the frames of a walk are while the view moves.
#include "core/cloud/cloud_frame.h"

namespace lightwalk {

/// Chooses the size of moving frames by what the frames before were like: the largest of which
/// nearly every pixel is reused, traced in time, or inferred from its own surface. A smaller
/// picture is blurred where the large one would be guessed. Who draws the camera between frames
/// gets fewer before they get smaller.
class MovingSize {
  public:
    /// Whether frames may take longer than a period.
    void set_patient(bool patient);
    /// Before the next frame: how many pixels it may have at most, of so many that are wished for.
    void limit(int width, int height, double most_pixels);
    /// Share of the width and of the height that are wished for, 0.15 ... 1.
    [[nodiscard]] double share() const;
    [[nodiscard]] int of(int side) const;
    /// What the next frame may take of a picture of which so many pixels are wished for, in periods
    /// of the rate of frames that is asked for: 1 ... 2.5.
    [[nodiscard]] double periods(int width, int height) const;
    /// A frame of this size was drawn while the view moved.
    /// @param budget  the time that there was for it [s]
    void record(const CloudReport& report, double budget);

  private:
    [[nodiscard]] int last_step(double pixels, double least) const;
    [[nodiscard]] int first_step() const;
    void step(int by, double pixels, double least);

    bool patient_ = false;
    int step_ = 5;          ///< of the table of shares; the first frames know little, and are small
    bool changed_ = false;  ///< the next frame is the first one of its size, which tells little
    int limit_ = 0;         ///< step of the largest share that is allowed
    int good_ = 0, bad_ = 0;  ///< frames in a row that call for a larger, or a smaller size
    int patience_ = 2;        ///< good frames until a larger size is tried
    int since_larger_ = 0;    ///< frames since one was; 0: none was
};

}  // namespace lightwalk
