#include "io/picture/picture_header.h"

#include <array>
#include <cstdio>

#include "io/options/view_text.h"

namespace lightwalk {
namespace {

std::string time_text(const std::tm& time) {
    std::array<char, 64> text{};
    (void)std::strftime(text.data(), text.size(), "%Y:%m:%d %H:%M:%S", &time);
    return text.data();
}

}  // namespace

PictureHeader make_picture_header(const PictureFacts& facts) {
    PictureHeader header;
    std::vector<std::string>& lines = header.lines;
    for (const std::string& line : facts.scene_lines) {
        if (!line.starts_with("#?")) lines.push_back(line);
    }
    if (!facts.command.empty()) lines.push_back(facts.command);
    if (!facts.software.empty()) lines.push_back("SOFTWARE= " + facts.software);
    if (facts.frame) lines.push_back("FRAME=" + std::to_string(*facts.frame));
    lines.push_back("VIEW= " + view_text(facts.view));
    if (facts.pixel_aspect < 0.995 || facts.pixel_aspect > 1.005) {
        std::array<char, 400> text{};
        (void)std::snprintf(text.data(), text.size(), "PIXASPECT=%f", facts.pixel_aspect);
        lines.emplace_back(text.data());
    }
    std::tm time{};
    if (localtime_r(&facts.time, &time) != nullptr) lines.push_back("CAPDATE= " + time_text(time));
    if (gmtime_r(&facts.time, &time) != nullptr) lines.push_back("GMT= " + time_text(time));
    lines.emplace_back("PRIMARIES= 0.6400 0.3300 0.2900 0.6000 0.1500 0.0600 0.3333 0.3333");
    return header;
}

}  // namespace lightwalk
