#include "io/photometry/ies_file.h"

#include <array>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "io/formats/words.h"
#include "io/photometry/number_words.h"

namespace lightwalk {
namespace {

constexpr double kMetresInFoot = 0.3048;
constexpr std::size_t kMostValues = std::size_t{1} << 24;  ///< of one distribution

/// The first line of files since 1991; those of 1986 have none.
struct IesLabel {
    std::string_view text;
    IesEdition edition;
};
constexpr std::array<IesLabel, 4> kLabels = {{{"IESNA91", IesEdition::until_1991},
                                              {"IESNA:LM-63-1995", IesEdition::of_1995},
                                              {"IESNA:LM-63-2002", IesEdition::since_2002},
                                              {"IES:LM-63-2019", IesEdition::since_2002}}};

constexpr std::array<std::string_view, 2> kLampKeywords = {"[LAMP]", "[LAMPCAT]"};
constexpr std::string_view kTiltMark = "TILT=";

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r\v\f";
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

LampTilt read_tilt(NumberWords& words) {
    LampTilt tilt;
    tilt.geometry = static_cast<int>(words.integer("geometry of the lamp in the luminaire", 1, 3));
    const std::size_t count = words.count("number of tilt angles", 2);
    tilt.angles = words.ascending(count, "a tilt angle");
    tilt.factors = words.reals(count, "a factor of a tilted lamp");
    return tilt;
}

class IesReader {
  public:
    IesReader(std::string_view text, const std::string& name)
        : rest_(text), where_{name, 0}, words_({}, where_.file) {}

    IesFile read() {
        read_header();
        if (const std::string_view tilt = tilt_; tilt == "INCLUDE")
            file_.tilt = read_tilt(words_);
        else if (tilt.empty())
            throw InputError(where_, "TILT= without NONE, INCLUDE or the name of a file");
        else if (tilt != "NONE")
            file_.tilt_file = tilt;
        read_numbers();
        return std::move(file_);
    }

  private:
    void read_header() {
        while (!rest_.empty()) {
            ++where_.line;
            const std::string_view line = take_line(rest_);
            if (line.starts_with(kTiltMark)) {
                tilt_ = trimmed(line.substr(kTiltMark.size()));
                words_ = NumberWords(rest_, where_.file, where_.line + 1);
                return;
            }
            if (where_.line == 1) read_label(trimmed(line));
            add_line(line);
        }
        throw InputError({where_.file, 0},
                         "not a photometric file of the IES: no line begins with TILT=");
    }

    void read_label(std::string_view line) {
        for (const IesLabel& label : kLabels) {
            if (line != label.text) continue;
            edition_ = label.edition;
            keywords_ = true;
        }
    }

    void add_line(std::string_view line) {
        file_.header.emplace_back(line);
        if (!keywords_) {
            file_.lamps.emplace_back(line);
            return;
        }
        const std::string_view text = trimmed(line);
        for (const std::string_view keyword : kLampKeywords) {
            if (text.starts_with(keyword)) file_.lamps.emplace_back(text.substr(keyword.size()));
        }
    }

    void read_numbers() {
        Photometry& photometry = file_.photometry;
        (void)words_.real("the number of lamps");
        (void)words_.real("lumens per lamp");
        photometry.factor = words_.not_negative("a multiplier of the intensities");
        const std::size_t verticals = words_.count("number of vertical angles", 2);
        const std::size_t horizontals = words_.count("number of horizontal angles", 1);
        photometry.type = static_cast<PhotometryType>(
            words_.integer("photometric type (1 is C, 2 is B, 3 is A)", 1, 3));
        read_body();
        photometry.factor *= words_.not_negative("a ballast factor");
        (void)words_.real("the ballast-lamp factor, or the file's generation type");
        file_.watts = words_.real("input watts");
        if (verticals > kMostValues / horizontals || verticals * horizontals > words_.most_left())
            throw words_.error("the file is too short for " + std::to_string(verticals) + " by " +
                               std::to_string(horizontals) + " intensities");
        photometry.vertical = words_.ascending(verticals, "a vertical angle");
        photometry.horizontal = words_.ascending(horizontals, "a horizontal angle");
        photometry.intensities = words_.reals(verticals * horizontals, "an intensity");
    }

    void read_body() {
        const bool feet = words_.integer("units (1 is feet, 2 is metres)", 1, 2) == 1;
        std::array<double, 3> sizes{};
        constexpr std::array<const char*, 3> kNames = {"the width of the luminous opening",
                                                       "its length", "its height"};
        for (std::size_t i = 0; i < sizes.size(); ++i)
            sizes[i] = words_.real(kNames[i]) * (feet ? kMetresInFoot : 1);
        const std::optional<LuminousBody> body =
            luminous_body(edition_, sizes[0], sizes[1], sizes[2]);
        if (!body)
            throw words_.error("width, length and height mean no luminous opening: " +
                               signs_of(sizes));
        file_.photometry.body = *body;
    }

    static std::string signs_of(const std::array<double, 3>& sizes) {
        std::string text = "they are";
        for (const double size : sizes)
            text += size > 0 ? " positive" : size < 0 ? " negative" : " zero";
        return text;
    }

    std::string_view rest_, tilt_;
    SourceLocation where_;  ///< the line last read of the header
    IesEdition edition_ = IesEdition::until_1991;
    bool keywords_ = false;
    NumberWords words_;
    IesFile file_;
};

}  // namespace

IesFile decode_ies(std::string_view text, const std::string& name) {
    return IesReader(text, name).read();
}

LampTilt decode_tilt(std::string_view text, const std::string& name) {
    NumberWords words(text, name);
    return read_tilt(words);
}

}  // namespace lightwalk
