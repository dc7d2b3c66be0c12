// evalglare: daylight glare probability and its kin, of a picture of a fisheye view.
#include <cstdio>
#include <optional>

#include "apps/command_run.h"
#include "apps/names/named_program.h"
#include "core/glare/dgp.h"
#include "core/glare/glare_indices.h"
#include "core/math/xyz.h"
#include "io/options/view_options.h"
#include "io/options/view_text.h"
#include "io/picture/picture.h"

namespace lightwalk {
namespace {

struct EvalglareCommand {
    View view;
    bool view_given = false, only_illuminance = false, only_version = false;
    double threshold = 2000;  ///< [cd/m²]; below 100: of the mean luminance
    double search_angle = 0.2, peak = 50000;
    double illuminance = 0;  ///< -i: measured, in place of the picture's; 0: the picture's [lx]
    std::string file;
};

std::vector<OptionRow> evalglare_rows(EvalglareCommand& c,
                                      const std::shared_ptr<FileSource>& files) {
    std::vector<OptionRow> rows = view_option_rows(c.view, files);
    const CustomOption file{
        [&c, files](OptionWords& words) { (void)take_view_option(words, c.view, *files); }};
    rows.push_back({"-vf FILE", file, "read the view from a view file or a picture"});
    for (OptionRow& row : rows) row.with.then = [&c] { c.view_given = true; };
    const RefusedOption table{": only the indices are printed; lightwalk walk shows the sources"};
    const RefusedOption task{": task zones are not supported"};
    const RefusedOption other{": it is not supported"};
    const std::vector<OptionRow> own{
        {"-b LIMIT", &c.threshold, "luminance of glare [cd/m²], or times the mean",
         With{.least = 1e-6}},
        {"-r ANGLE", &c.search_angle, "pixels this near are one source [rad]",
         With{.least = 1e-6, .most = kPi}},
        {"-Y LIMIT", &c.peak, "luminance of peaks [cd/m²]", With{.least = 1e-6}},
        {"-y", Action{[] {}}, "find peaks"},
        {"-i LUX", &c.illuminance, "vertical illuminance", With{.least = 0}},
        {"-V", &c.only_illuminance, "print the vertical illuminance"},
        {"-v", &c.only_version, "print the version"},
        {"-d", table},
        {"-D", table},
        {"-c FILE", table},
        {"-t X Y ANGLE", task},
        {"-T X Y ANGLE", task},
        {"-I EV YMAX YMIN", other},
        {"-N X Y ANGLE", other},
        {"-q MODE", other},
        {"-p", other}};
    rows.insert(rows.end(), own.begin(), own.end());
    return rows;
}

/// The last view that the header tells of, if any.
void take_header_view(const PictureHeader& header, View& view) {
    for (const std::string& line : header.lines) {
        constexpr std::string_view kView = "VIEW=";
        if (line.starts_with(kView)) parse_view_string(line.substr(kView.size()), view);
    }
}

GlareReport report_of(const EvalglareCommand& c, const FieldPicture& picture) {
    constexpr double kLeastLuminance = 100;  ///< a smaller threshold is a factor
    GlareParams params;
    params.threshold = c.threshold;
    params.merge_angle = c.search_angle / 2;
    params.peak = c.peak;
    params.whole_pixels = true;
    if (c.threshold < kLeastLuminance) {
        const double mean = analyse_glare(picture, c.view, params).average_luminance;
        if (mean > 0) params.threshold = c.threshold * mean;
    }
    GlareReport report = analyse_glare(picture, c.view, params);
    if (c.illuminance > 0) {
        double glare = 0;
        for (const GlareSource& source : report.sources) glare += source.glare;
        report.vertical_illuminance = c.illuminance;
        report.dgp = daylight_glare_probability(c.illuminance, glare);
    }
    return report;
}

}  // namespace

int run_evalglare(const std::string& name, const std::vector<std::string>& line,
                  Communicator* /*ranks*/) {
    const std::shared_ptr<FileSource> files = real_files();
    EvalglareCommand command;
    const OptionTable table({name, ~0U}, {evalglare_rows(command, files)});
    OptionWords words(line, files);
    while (words.at_option()) {
        if (words.option().starts_with('-') && words.option() != "-") {
            if (!table.take(words)) table.refuse(words);
            continue;
        }
        if (!command.file.empty()) throw UsageError("expected one picture");
        command.file = words.option();
        words.skip(1);
    }
    if (command.only_version) {
        std::puts(named_version().c_str());
        return kSuccessStatus;
    }
    const bool piped = command.file.empty() || command.file == "-";
    PictureHeader header;
    const Picture picture = read_hdr(piped ? files->standard_input() : files->read(command.file),
                                     piped ? "standard input" : command.file, &header);
    if (!command.view_given) take_header_view(header, command.view);
    const GlareReport report = report_of(command, {picture.width, picture.height, picture.pixels});
    if (command.only_illuminance) {
        std::printf("%f\n", report.vertical_illuminance);
        return kSuccessStatus;
    }
    if (!report.within_assessments)
        std::fprintf(stderr,
                     "Notice: outside of what people were asked about (DGP 0.2 to 0.8, at "
                     "least 380 lux): dgp is an extrapolation\n");
    const GlareIndices indices = glare_indices(report, Camera(command.view).forward());
    std::printf("dgp,dgi,ugr,vcp,cgi,Lveil: %f %f %f %f %f %f  \n", report.dgp, indices.dgi,
                indices.ugr, indices.vcp, indices.cgi, indices.evalglare_veil);
    return kSuccessStatus;
}

}  // namespace lightwalk
