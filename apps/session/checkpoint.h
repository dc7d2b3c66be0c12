#pragma once
// Finished blocks, and rounds of ambient values, on disk, so that a run that was killed goes on
// where it stood.
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "io/files/record_log.h"
#include "parallel/checkpoint_sink.h"

namespace lightwalk {

/// A log of blocks: frame number and rectangle (five i32), then the pixels as encode_piece packs
/// them; and of rounds of ambient values, in whose place for the rectangle is none: x0 is -1, y0
/// says whether it is how the picture's rounds begin (0) or one of their steps (1), and the rest is
/// 0. Where the values of an ambient file are what a run begins with, a record says which ones (y0
/// is 2): what was kept before it is void. A thread of its own writes; what is kept is on disk at
/// most two seconds later.
class Checkpoint {
  public:
    /// Blocks of a file that is there already are known.
    /// @param header  what the blocks depend on, one line each: a file with other lines is refused
    /// @param beginning  which values of an ambient file they depend on (AmbientStore::beginning):
    /// with others than those of the run before nothing is known, and all is kept anew. On disk at
    /// once, as the file may grow from now on. "": on none
    /// Throws InputError.
    Checkpoint(const std::string& path, const std::string& header, WarningSink& warnings,
               const std::string& beginning = {});
    /// What was kept is on disk when this is over.
    ~Checkpoint() = default;
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    /// The `beginning` of the run that has left a file; "": there is none, or no such run.
    [[nodiscard]] static std::string beginning_of(const std::string& path);

    /// The blocks of one picture of the run, which must not outlive this.
    /// @param whole  all of its pixels; known blocks beyond are left out
    [[nodiscard]] std::shared_ptr<CheckpointSink> picture(int frame, const PixelRectangle& whole);
    /// Whether an earlier run has kept rounds of this picture.
    [[nodiscard]] bool has_rounds(int frame) const { return known_rounds_.contains(frame); }
    /// The picture is written: its blocks are no longer needed.
    void forget(int frame);
    /// The run is whole: removes the file.
    void remove();

  private:
    class Picture;
    struct Known {
        PixelRectangle block;
        std::string bytes;
    };
    struct KnownRounds {
        std::string beginning;
        std::vector<std::string> steps;
    };
    struct Kept {
        int frame = 0;
        PixelRectangle block;
        std::vector<PixelValue> values;
        std::string of_rounds = {};
    };
    void read(std::string_view record);
    void keep(Kept kept);
    void write(const std::stop_token& ending);

    std::map<int, std::vector<Known>> known_;  ///< by frame
    std::map<int, KnownRounds> known_rounds_;  ///< likewise
    std::string known_beginning_;
    std::unique_ptr<RecordLog> log_;
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable_any changed_;
    std::deque<Kept> kept_;       ///< to be written
    std::exception_ptr problem_;  ///< why it could not be written
    std::jthread writer_;
};

}  // namespace lightwalk
