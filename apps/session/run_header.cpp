#include "apps/session/run_header.h"

#include <array>
#include <ctime>

namespace lightwalk {
namespace {

std::string date_line(const char* name, const std::tm& time) {
    std::array<char, 64> text{};
    std::strftime(text.data(), text.size(), "%Y:%m:%d %H:%M:%S", &time);
    return std::string(name) + "= " + text.data();
}

}  // namespace

std::vector<std::string> history_header(const std::vector<std::string>& scene_header,
                                        const std::string& command_line) {
    std::vector<std::string> lines;
    for (const std::string& line : scene_header) {
        if (!line.starts_with("#?")) lines.push_back(line);
    }
    lines.push_back(command_line);
    lines.emplace_back("SOFTWARE= Lightwalk " LIGHTWALK_VERSION);
    return lines;
}

std::vector<std::string> date_lines() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    std::tm universal{};
    localtime_r(&now, &local);
    gmtime_r(&now, &universal);
    return {date_line("CAPDATE", local), date_line("GMT", universal)};
}

}  // namespace lightwalk
