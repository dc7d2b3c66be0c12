#include "io/rays/ray_intervals.h"

#include <cstdint>
#include <cstring>
#include <utility>

#include "core/math/student_t.h"
#include "io/options/option_words.h"

namespace lightwalk {
namespace {

constexpr std::string_view kWithIntervals = "vrx";
constexpr std::string_view kByChance = "VWlRX";

bool has_interval(char letter) {
    return kWithIntervals.find(letter) != std::string_view::npos;
}

/// Letters of records with as many numbers, and names, as those with half-widths have.
std::string with_half_widths(std::string_view letters) {
    std::string all;
    for (const char letter : letters) all += std::string(has_interval(letter) ? 2 : 1, letter);
    return all;
}

/// Takes values off the front of bytes.
class PartCursor {
  public:
    explicit PartCursor(std::string_view bytes) : rest_(bytes) {}
    template <class Value>
    Value take() {
        Value value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string_view take(std::size_t count) {
        const std::string_view taken = rest_.substr(0, count);
        rest_.remove_prefix(count);
        return taken;
    }
    [[nodiscard]] bool at_end() const { return rest_.empty(); }

  private:
    std::string_view rest_;
};

NumberFormat without_chance(std::string_view letters, NumberFormat format) {
    if (format == NumberFormat::rgbe)
        throw UsageError("option --interval: format c holds one colour, and no half-width");
    const std::size_t at = letters.find_first_of(kByChance);
    if (at != std::string_view::npos)
        throw UsageError(std::string("option --interval: output field '") + letters[at] +
                         "' has no interval, expected v, r or x beside o d w L p c n N s m M ~");
    if (!letters.empty() && letters.find_first_of(kWithIntervals) == std::string_view::npos)
        throw UsageError("option --interval: expected some value output, v, r or x");
    return format;
}

}  // namespace

RayIntervals::RayIntervals(std::string_view letters, NumberFormat format, ColorOutput color)
    : format_(without_chance(letters, format)), header_(with_half_widths(letters), format, color) {
    while (!letters.empty()) {
        const std::size_t next = letters.find_first_of(kWithIntervals);
        const std::string_view part = letters.substr(0, next == 0 ? 1 : next);
        letters.remove_prefix(part.size());
        RayRecords records(part, next == 0 ? NumberFormat::real64 : format, color);
        const int numbers = next == 0 ? records.components() : 0;
        parts_.push_back({std::move(records), numbers});
    }
}

void RayIntervals::append(const RayRecord& traced, const Scene& scene, int answer,
                          std::string& bytes) const {
    for (const Part& part : parts_) {
        if (part.numbers > 0) {
            part.records.append(traced, scene, bytes);
        } else if (answer == 0) {
            std::string text;
            part.records.append(traced, scene, text);
            if (format_ == NumberFormat::text) text.pop_back();  // the end of the line
            const auto size = static_cast<std::uint32_t>(text.size());
            bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
            bytes += text;
        }
    }
}

std::string RayIntervals::join(std::span<const std::string> answers) const {
    std::vector<PartCursor> cursors(answers.begin(), answers.end());
    std::vector<double> values(answers.size());
    std::vector<double> half_widths;
    std::string records;
    while (!cursors.front().at_end()) {
        for (const Part& part : parts_) {
            if (part.numbers == 0) {
                const auto size = cursors.front().take<std::uint32_t>();
                records += cursors.front().take(size);
            }
            half_widths.clear();
            for (int i = 0; i < part.numbers; ++i) {
                for (std::size_t k = 0; k < values.size(); ++k)
                    values[k] = cursors[k].take<double>();
                const MeanInterval interval = mean_interval(values);
                append_number(interval.mean, format_, records);
                half_widths.push_back(interval.half_width);
            }
            for (const double half : half_widths) append_number(half, format_, records);
        }
        if (format_ == NumberFormat::text) records += '\n';
    }
    return records;
}

}  // namespace lightwalk
