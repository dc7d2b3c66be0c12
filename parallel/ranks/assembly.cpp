#include "parallel/ranks/assembly.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "core/error.h"
#include "parallel/ranks/piece_codec.h"

namespace lightwalk {
namespace {

[[noreturn]] void refuse_parts() {
    throw InputError("the parts of a picture that ranks have sent do not make one");
}

/// Calls visit(index of the pixel in the picture, index in the part). In the picture rows come from
/// the bottom.
template <class Visit>
void for_pixels(const PixelRectangle& area, int width, Visit visit) {
    std::size_t in_part = 0;
    for (int y = area.y0; y < area.y1; ++y)
        for (int x = area.x0; x < area.x1; ++x, ++in_part)
            visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x),
                  in_part);
}

/// Parts of a picture of this size, of which none overlaps another one.
void check_parts(const std::vector<PixelRectangle>& areas, int width, int height) {
    const PixelRectangle whole{0, 0, width, height};
    std::size_t pixels = 0;
    for (const PixelRectangle& area : areas) {
        if (area.x0 < 0 || area.y0 < 0 || area.x1 > width || area.y1 > height) refuse_parts();
        pixels += area.pixels();
    }
    if (pixels != whole.pixels()) refuse_parts();
}

using Parts = std::vector<const FramePart*>;

/// In an order that does not depend on which came first.
Parts sorted_parts(const FrameOrder& order, const FinishedFrame& finished) {
    if (finished.frame != order.number) refuse_parts();
    Parts parts;
    std::vector<PixelRectangle> areas;
    for (const FramePart& part : finished.parts) {
        if (part.area.empty()) continue;
        parts.push_back(&part);
        areas.push_back(part.area);
    }
    check_parts(areas, order.width, order.height);
    std::sort(parts.begin(), parts.end(), [](const FramePart* a, const FramePart* b) {
        return std::tie(a->area.y0, a->area.x0) < std::tie(b->area.y0, b->area.x0);
    });
    return parts;
}

void add_report(const CloudReport& part, CloudReport& all) {
    for (std::size_t CloudReport::*count :
         {&CloudReport::reused, &CloudReport::filled, &CloudReport::inferred, &CloudReport::points})
        all.*count += part.*count;
    all.rays += part.rays;
    for (std::size_t i = 0; i < all.uncached.size(); ++i) all.uncached[i] += part.uncached[i];
    for (double CloudReport::*seconds :
         {&CloudReport::project_seconds, &CloudReport::check_seconds, &CloudReport::trace_seconds,
          &CloudReport::infer_seconds, &CloudReport::keep_seconds})
        all.*seconds = std::max(all.*seconds, part.*seconds);
    all.audit_errors.insert(all.audit_errors.end(), part.audit_errors.begin(),
                            part.audit_errors.end());
    all.audit_floors.insert(all.audit_floors.end(), part.audit_floors.begin(),
                            part.audit_floors.end());
}

/// The pixels of a part. @param decoded  holds them where the part has them compressed
const std::vector<PixelValue>& values_of(const FramePart& part, std::vector<PixelValue>& decoded) {
    if (const auto* bytes = std::get_if<std::string>(&part.pixels))
        return decoded = decode_piece(part.area, *bytes);
    const auto& values = std::get<std::vector<PixelValue>>(part.pixels);
    if (values.size() != part.area.pixels()) refuse_parts();
    return values;
}

void put_together(const Parts& parts, int width, const TaskRunner& task_runner,
                  AssembledFrame& whole) {
    task_runner.run(parts.size(), [&](std::size_t number) {
        const FramePart* const part = parts[number];
        std::vector<PixelValue> decoded;
        const std::vector<PixelValue>& values = values_of(*part, decoded);
        std::vector<std::uint8_t> known(values.size(), 1);
        for (const std::uint32_t i : part->unknown) {
            if (i >= known.size()) refuse_parts();
            known[i] = 0;
        }
        for_pixels(part->area, width, [&](std::size_t at, std::size_t i) {
            whole.frame.radiance[at] = values[i].radiance;
            whole.frame.distance[at] = values[i].distance;
            whole.frame.known[at] = known[i];
        });
    });
}

std::vector<PixelOrigin> origins_of(const Parts& parts, int width, std::size_t pixels) {
    std::vector<PixelOrigin> origins(pixels);
    for (const FramePart* part : parts) {
        if (part->origins.size() != part->area.pixels()) refuse_parts();
        for_pixels(part->area, width,
                   [&](std::size_t at, std::size_t i) { origins[at] = part->origins[i]; });
    }
    return origins;
}

/// What the parts have of the pixels that were to be refined, in the order's order.
void put_refined_together(const Parts& parts, const FrameOrder& order, AssembledFrame& whole) {
    whole.refined.reserve(order.refined.size());
    std::vector<std::size_t> next(parts.size());  // of the parts' pixels
    for (const PixelPlace& place : order.refined) {
        const auto part = std::find_if(parts.begin(), parts.end(), [&](const FramePart* one) {
            return one->area.contains(place);
        });
        if (part == parts.end()) refuse_parts();
        std::size_t& at = next[static_cast<std::size_t>(part - parts.begin())];
        const std::vector<std::optional<PixelValue>>& refined = (*part)->refined;
        if (at >= refined.size()) refuse_parts();
        const std::vector<Rgb>& groups = (*part)->refined_groups;
        const std::size_t count = groups.size() / refined.size();
        const auto own = std::span(groups).subspan(at * count, count);
        whole.refined_groups.insert(whole.refined_groups.end(), own.begin(), own.end());
        whole.refined.push_back(refined[at++]);
    }
    if (whole.refined_groups.size() % std::max<std::size_t>(whole.refined.size(), 1) != 0)
        refuse_parts();
}

/// Calls visit(index of the pixel in the frame, value) for a part of a picture. In frames rows come
/// from the top.
template <class Visit>
void unpack(const PixelRectangle& area, const std::string& bytes, int width, int height,
            Visit visit) {
    const std::vector<PixelValue> values = decode_piece(area, bytes);
    std::size_t from = 0;
    for (int y = area.y0; y < area.y1; ++y) {
        std::size_t to =
            static_cast<std::size_t>(height - 1 - y) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(area.x0);
        for (int x = area.x0; x < area.x1; ++x, ++from, ++to) visit(to, values[from]);
    }
}

}  // namespace

Frame assemble_picture(const FinishedPicture& picture, int width, int height) {
    Frame frame;
    frame.width = width;
    frame.height = height;
    frame.radiance.resize(PixelRectangle{0, 0, width, height}.pixels());
    frame.distance.resize(frame.radiance.size());
    std::vector<PixelRectangle> areas;
    for (const PicturePart& part : picture.parts) areas.push_back(part.work.block);
    check_parts(areas, width, height);
    if (!picture.parts.empty()) frame.groups.resize(picture.parts.front().layers.size());
    for (std::vector<Rgb>& group : frame.groups) group.resize(frame.radiance.size());
    for (const PicturePart& part : picture.parts) {
        const PixelRectangle& area = part.work.block;
        if (part.layers.size() != frame.groups.size()) refuse_parts();
        unpack(area, part.bytes, width, height, [&](std::size_t to, const PixelValue& value) {
            frame.radiance[to] = value.radiance;
            frame.distance[to] = value.distance;
        });
        for (std::size_t g = 0; g < frame.groups.size(); ++g)
            unpack(area, part.layers[g], width, height,
                   [&](std::size_t to, const PixelValue& value) {
                       frame.groups[g][to] = value.radiance;
                   });
    }
    frame.complete = true;
    return frame;
}

AssembledFrame assemble_frame(const FrameOrder& order, const FinishedFrame& finished,
                              const TaskRunner& task_runner) {
    const Parts parts = sorted_parts(order, finished);
    AssembledFrame whole;
    whole.frame.area = {0, 0, order.width, order.height};
    const std::size_t pixels = whole.frame.area.pixels();
    whole.frame.radiance.resize(pixels);
    whole.frame.distance.resize(pixels);
    whole.frame.known.resize(pixels);
    CloudReport& report = whole.frame.report;
    report.pixels = pixels;
    report.tightness = order.rules.tightness;
    for (const FramePart* part : parts) add_report(part->report, report);
    report.points = std::min(static_cast<std::size_t>(order.most_points), report.points);
    if (!order.rests) put_together(parts, order.width, task_runner, whole);
    if (order.tells_origins) whole.frame.origins = origins_of(parts, order.width, pixels);
    put_refined_together(parts, order, whole);
    return whole;
}

}  // namespace lightwalk
