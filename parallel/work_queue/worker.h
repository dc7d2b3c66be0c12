#pragma once
// A rank that traces: requests work in the name of its threads, and owns a part of every picture.
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "parallel/sub_images.h"
#include "parallel/work_queue/outbox.h"

namespace lightwalk {

/// Makes bytes of a finished part of a picture.
using EncodePiece =
    std::function<std::string(const PixelRectangle& block, std::vector<PixelValue> values)>;

/// A job is forgotten when so many others have begun after it: programs keep no more open at once.
inline constexpr JobId kJobsAtOnce = 8;

/// A pure step for each message, as the queue (work_queue.h).
class Worker {
  public:
    struct Options {
        int self = 0;
        int queue = 0;                                    ///< rank that grants it work
        std::size_t index = 0;                            ///< among the workers
        std::shared_ptr<const std::vector<int>> workers;  ///< ranks of all
        int slots = 1;                                    ///< threads that trace here
        int ahead = 1;  ///< pieces of work that wait here so that no thread does
        EncodePiece encode;
    };
    explicit Worker(Options options) : options_(std::move(options)) {}

    /// Requests the first pieces of work.
    void begin(Outbox& out);
    // From the queue.
    void handle(Announcement announcement, Outbox& out);
    void handle(WorkGrant grant, Outbox& out) { out.tracers.emplace_back(std::move(grant)); }
    /// From the rank's threads: a piece of work is traced. Requests another one.
    void finish(const FinishedWork& finished, TracedWork traced, Outbox& out);
    /// From other workers: pixels of the own part.
    void store(Pixels pixels, Outbox& out);

  private:
    struct Job {
        bool started = false;  ///< pixels may come before the announcement that they will
        bool keep = true, log = false;
        SubImages parts;                 ///< who owns what
        std::vector<PixelValue> values;  ///< of the own part, row by row from the bottom
        std::vector<Rgb> groups;         ///< of these, by pixel, then light group; empty: none
        std::vector<bool> there;         ///< which of them
        std::size_t missing = 0;         ///< how many are not
        std::vector<Pixels> early;
    };
    void start(PictureJob job, Outbox& out);
    void share_out(Pixels pixels, Outbox& out);
    [[nodiscard]] PicturePart finished_part(JobId id, Job& job) const;
    void send(int to, Message message, Outbox& out) const {
        out.messages.push_back({options_.self, to, std::move(message)});
    }
    [[nodiscard]] PixelRectangle own_part(const Job& job) const {
        return job.parts[options_.index];
    }

    Options options_;
    std::map<JobId, Job> jobs_;  ///< the newest kJobsAtOnce
};

/// The pixels of `part` that lie in `block`, whose values are given (or none are).
[[nodiscard]] Pixels cut_pixels(const Pixels& pixels, const PixelRectangle& part);

}  // namespace lightwalk
