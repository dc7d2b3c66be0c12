#include "apps/picture_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "apps/interrupt.h"
#include "io/options/frame_name.h"
#include "io/options/view_text.h"

namespace lightwalk {
namespace {

constexpr std::array<double, 8> kStandardPrimaries{.64, .33, .29, .6, .15, .06, 1.0 / 3, 1.0 / 3};

std::string formatted(const char* format, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string primaries_line(const RenderCommand& command) {
    std::string line = "PRIMARIES=";
    for (const double value : command.primaries.value_or(kStandardPrimaries))
        line += formatted(" %.4f", value);
    return line;
}

void write_to_stdout(const std::string& bytes) {
    const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
    if (!whole || std::fflush(stdout) != 0) throw InputError("cannot write standard output");
}

bool is_empty(const PictureSize& size) {
    return size.width <= 0 || size.height <= 0;
}

}  // namespace

FrameOptions frame_options(const RenderCommand& command, const PictureSize& size) {
    FrameOptions options;
    options.width = size.width;
    options.height = size.height;
    options.pixels = command.pixels;
    options.seed = command.settings.light.seed;
    options.use_distances = !command.depth.empty();
    return options;
}

bool PictureSeries::make(const std::vector<WantedPicture>& wanted, PictureMaker& maker) {
    std::deque<PictureSize> sizes;
    std::size_t ordered = 0;
    for (std::size_t taken = 0; taken < wanted.size(); ++taken) {
        for (; ordered < std::min(wanted.size(), taken + maker.ahead()); ++ordered)
            sizes.push_back(order(wanted[ordered], maker));
        const PictureSize size = sizes.front();
        sizes.pop_front();
        if (!finish(wanted[taken], size, maker)) return false;
    }
    if (checkpoint_ != nullptr) checkpoint_->remove();
    if (film_) film_->finish();
    return true;
}

PictureSize PictureSeries::order(const WantedPicture& wanted, PictureMaker& maker) {
    const Camera camera(wanted.view);
    const PictureSize size =
        fit_picture(command_.x, command_.y, camera.aspect(), command_.pixel_aspect);
    check_size(size);
    if (wanted.frame > 0 && command_.report_interval > 0) {
        std::fprintf(stderr, "FRAME %d:%s\n", wanted.frame, view_text(wanted.view).c_str());
    }
    if (is_empty(size)) return size;
    const auto request = std::make_shared<PictureRequest>(
        wanted.view, wanted.before ? &*wanted.before : nullptr, frame_options(command_, size));
    if (checkpoint_ != nullptr)
        request->checkpoint = checkpoint_->picture(wanted.frame, request->options.area());
    maker.order(request);
    return size;
}

/// False: interrupted.
bool PictureSeries::finish(const WantedPicture& wanted, const PictureSize& size,
                           PictureMaker& maker) {
    set_interrupt_phase(InterruptPhase::request);
    const Stopwatch watch;
    const std::optional<Frame> frame = is_empty(size) ? Frame{} : maker.take();
    statistics_.render_seconds += watch.seconds();
    statistics_.width = size.width;
    statistics_.height = size.height;
    ++statistics_.frames;
    if (!frame) return false;
    set_interrupt_phase(InterruptPhase::finish);
    write(*frame, header(wanted, size.pixel_aspect), wanted.frame);
    if (checkpoint_ != nullptr) checkpoint_->forget(wanted.frame);
    if (interrupt_flag().requested()) return false;
    set_interrupt_phase(InterruptPhase::leave);
    return true;
}

void PictureSeries::check_size(const PictureSize& size) {
    constexpr double kMostPixels = 1 << 28;
    if (is_empty(size)) warnings_.warn("empty output picture");
    if (static_cast<double>(size.width) * size.height > kMostPixels) {
        throw UsageError("options -x and -y: more than " + formatted("%.0f", kMostPixels) +
                         " pixels");
    }
}

PictureHeader PictureSeries::header(const WantedPicture& wanted, double pixel_aspect) const {
    PictureHeader header{history_header(model_.header, command_.history)};
    if (wanted.frame > 0) header.lines.push_back("FRAME=" + std::to_string(wanted.frame));
    header.lines.push_back("VIEW= " + view_text(wanted.view));
    if (pixel_aspect < 0.995 || pixel_aspect > 1.005) {
        header.lines.push_back("PIXASPECT=" + formatted("%f", pixel_aspect));
    }
    for (const std::string& line : date_lines()) header.lines.push_back(line);
    if (!command_.xyz) header.lines.push_back(primaries_line(command_));
    header.xyz = command_.xyz;
    return header;
}

void PictureSeries::write(const Frame& frame, const PictureHeader& header, int number) {
    const Picture picture{frame.width, frame.height, frame.radiance};
    if (keeps_exposure_ && tone_.automatic) {
        const double ev = std::log2(choose_tone(picture, tone_).scale);
        if (std::isfinite(ev)) tone_ = {false, ev, tone_.curve};
    }
    if (!command_.depth.empty()) {
        write_depth(frame_name(command_.depth, number), frame.width, frame.height, frame.distance);
    }
    if (command_.output.empty())
        write_to_stdout(encode_hdr(picture, header));
    else if (command_.walk && is_film(command_.output))
        add_to_film(picture);
    else
        write_picture(frame_name(command_.output, number), picture, header, tone_);
}

void PictureSeries::add_to_film(const Picture& picture) {
    if (picture.pixels.empty()) return;
    if (!film_) film_.emplace(command_.output, picture.width, picture.height, command_.walk->rate);
    film_->add(picture, choose_tone(picture, tone_));
}

}  // namespace lightwalk
