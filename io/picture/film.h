#pragma once
// Films: the program ffmpeg encodes frames that it gets through a pipe.
#include <functional>
#include <string>

#include "io/picture/picture.h"
#include "io/picture/tone.h"

namespace lightwalk {

/// Whether a file's name is that of a film (.mp4).
[[nodiscard]] bool is_film(const std::string& path);

/// Path of the program ffmpeg. Throws InputError where PATH has none.
[[nodiscard]] std::string film_encoder();

/// A film on its way. The file appears when it is whole: until finish() it has another name, and
/// whatever ends this earlier removes it.
class Film {
  public:
    /// Starts the encoder. Throws InputError.
    /// @param width,height  of all frames [pixels]
    /// @param rate          frames a second
    /// @param unfinished    told the name of a file that is to be removed should the process end
    ///                      before it is told ""; none: nobody
    Film(std::string path, int width, int height, double rate,
         std::function<void(const std::string& path)> unfinished = {});
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// The next frame. Throws InputError for one of another size, and where the encoder has failed.
    void add(const Picture& picture, const DisplayTone& tone);
    /// The film is whole. Throws InputError where the encoder has failed.
    void finish();

  private:
    void start(const std::string& encoder, double rate);
    /// Ends the encoder's input and waits for its exit status.
    [[nodiscard]] int wait();

    void tell_unfinished(const std::string& path) const {
        if (unfinished_) unfinished_(path);
    }

    std::string path_, part_;
    int width_, height_;
    std::function<void(const std::string& path)> unfinished_;
    int process_ = -1, input_ = -1;
};

}  // namespace lightwalk
