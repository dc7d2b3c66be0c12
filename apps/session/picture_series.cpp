#include "apps/session/picture_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <utility>

#include "apps/session/run_header.h"
#include "apps/session/stopwatch.h"
#include "io/options/frame_name.h"
#include "io/options/view_text.h"
#include "io/picture/layers.h"

namespace lightwalk {
namespace {

constexpr std::array<double, 8> kStandardPrimaries{.64, .33, .29, .6, .15, .06, 1.0 / 3, 1.0 / 3};

std::string formatted(const char* format, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string primaries_line(const SeriesOutput& output) {
    std::string line = "PRIMARIES=";
    for (const double value : output.primaries.value_or(kStandardPrimaries))
        line += formatted(" %.4f", value);
    return line;
}

}  // namespace

PictureSeries::PictureSeries(SeriesOutput output, SeriesObserver observer, const StopFlag& stop,
                             Checkpoint* checkpoint)
    : output_(std::move(output)),
      observer_(std::move(observer)),
      stop_(stop),
      checkpoint_(checkpoint) {
    if (output_.denoise) denoiser_.emplace();
}

bool PictureSeries::make(const std::vector<WantedPicture>& wanted, Renderer& renderer) {
    std::deque<Started> started;
    std::size_t begun = 0;
    for (std::size_t done = 0; done < wanted.size(); ++done) {
        for (; begun < std::min(wanted.size(), done + renderer.pictures_ahead()); ++begun)
            started.push_back(start(wanted[begun], renderer));
        const Started oldest = started.front();
        started.pop_front();
        if (!finish(wanted[done], oldest, renderer)) return false;
    }
    if (checkpoint_ != nullptr) checkpoint_->remove();
    if (film_) film_->finish();
    return true;
}

PictureSeries::Started PictureSeries::start(const WantedPicture& wanted, Renderer& renderer) {
    const PictureSize size = observer_.size_of(wanted.view);
    if (observer_.begins) observer_.begins(wanted);
    if (size.width <= 0 || size.height <= 0) return {size, std::nullopt};
    PictureTask task;
    task.view = wanted.view;
    task.before = wanted.before;
    task.width = size.width;
    task.height = size.height;
    if (checkpoint_ != nullptr)
        task.checkpoint = checkpoint_->picture(wanted.frame, {0, 0, size.width, size.height});
    return {size, renderer.start(std::move(task))};
}

/// False: stopped.
bool PictureSeries::finish(const WantedPicture& wanted, const Started& started,
                           Renderer& renderer) {
    enter(SeriesStage::rendering);
    const Stopwatch watch;
    std::optional<RenderedPicture> picture =
        started.ticket ? renderer.finish(*started.ticket) : RenderedPicture{};
    result_.seconds += watch.seconds();
    result_.width = started.size.width;
    result_.height = started.size.height;
    ++result_.frames;
    if (!picture) return false;
    enter(SeriesStage::writing);
    write(*picture, header(wanted, started.size.pixel_aspect), wanted.frame);
    if (checkpoint_ != nullptr) checkpoint_->forget(wanted.frame);
    if (stop_.requested()) return false;
    enter(SeriesStage::between);
    return true;
}

void PictureSeries::enter(SeriesStage stage) const {
    if (observer_.enters) observer_.enters(stage);
}

PictureHeader PictureSeries::header(const WantedPicture& wanted, double pixel_aspect) const {
    PictureHeader header{output_.history};
    if (wanted.frame > 0) header.lines.push_back("FRAME=" + std::to_string(wanted.frame));
    header.lines.push_back("VIEW= " + view_text(wanted.view));
    if (pixel_aspect < 0.995 || pixel_aspect > 1.005) {
        header.lines.push_back("PIXASPECT=" + formatted("%f", pixel_aspect));
    }
    for (const std::string& line : date_lines()) header.lines.push_back(line);
    if (!output_.xyz) header.lines.push_back(primaries_line(output_));
    header.xyz = output_.xyz;
    return header;
}

void PictureSeries::write(RenderedPicture& rendered, const PictureHeader& header, int number) {
    Picture picture{rendered.width, rendered.height, std::move(rendered.radiance)};
    if (denoiser_) {
        if (!rendered.half.empty() && observer_.denoised)
            observer_.denoised(
                denoiser_->errors(picture, rendered.half, choose_tone(picture, output_.tone)));
        (*denoiser_)(picture);
    }
    ToneMapping& tone = output_.tone;
    if (output_.keep_exposure && tone.automatic) {
        const double ev = std::log2(choose_tone(picture, tone).scale);
        if (std::isfinite(ev)) tone = {false, ev, tone.curve};
    }
    if (!output_.depth.empty()) {
        write_depth(frame_name(output_.depth, number), picture.width, picture.height,
                    rendered.distance);
    }
    if (output_.layers)
        write_layers_of(picture, rendered, header, number);
    else if (output_.picture.empty())
        output_.bytes(encode_hdr(picture, header));
    else if (output_.film_rate)
        add_to_film(picture);
    else if (!rendered.error.empty() && is_exr_picture(output_.picture))
        write_exr(frame_name(output_.picture, number), picture, rendered.error, header);
    else
        write_picture(frame_name(output_.picture, number), picture, header, tone);
}

void PictureSeries::write_layers_of(const Picture& whole, const RenderedPicture& rendered,
                                    const PictureHeader& header, int number) const {
    std::vector<PictureLayer> layers;
    for (const RenderedLayer& layer : rendered.layers)
        layers.push_back({layer.name, layer.radiance});
    write_layers(output_.picture, whole, layers, rendered.error, header,
                 [&](const std::string& pattern) { return frame_name(pattern, number); });
}

void PictureSeries::add_to_film(const Picture& picture) {
    if (picture.pixels.empty()) return;
    if (!film_)
        film_.emplace(output_.picture, picture.width, picture.height, *output_.film_rate,
                      observer_.unfinished_file);
    film_->add(picture, choose_tone(picture, output_.tone));
}

}  // namespace lightwalk
