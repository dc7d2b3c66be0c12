// vwrays: the rays of a view, or of the view of a picture, as rtrace and rcontrib read them.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <optional>

#include "apps/command_run.h"
#include "apps/names/named_program.h"
#include "core/math/random.h"
#include "io/formats/header.h"
#include "io/options/option_words.h"
#include "io/options/view_options.h"
#include "io/options/view_text.h"
#include "io/picture/resolution_line.h"

namespace lightwalk {
namespace {

struct VwraysCommand {
    View view;
    int x = 512, y = 512;
    double pixel_aspect = 1, jitter = 0, aperture = 0;
    int repeat = 1;
    bool from_input = false, dimensions = false;
    char format = 'a';
    std::string picture;
};

std::vector<OptionRow> vwrays_rows(VwraysCommand& c, const std::shared_ptr<FileSource>& files) {
    std::vector<OptionRow> rows = view_option_rows(c.view, files);
    const auto take_file = [&c, files](OptionWords& words) {
        (void)take_view_option(words, c.view, *files);
    };
    const auto take_format = [&c](OptionWords& words) {
        const std::string letter = words.option().substr(2);
        if (letter != "a" && letter != "f" && letter != "d") return false;
        c.format = letter[0];
        words.skip(1);
        return true;
    };
    const Action ignored{[] {}};
    const std::vector<OptionRow> own{
        {"-vf FILE", CustomOption{take_file}, "read the view from a view file or a picture"},
        {"-x N", &c.x, "largest width [pixels]", With{.least = 1, .most = 1 << 20}},
        {"-y N", &c.y, "largest height [pixels]", With{.least = 1, .most = 1 << 20}},
        {"-pa A", &c.pixel_aspect, "height / width of a pixel", With{.least = 0}},
        {"-pj J", &c.jitter, "jitter of a ray within its pixel", With{.least = 0, .most = 1}},
        {"-pd D", &c.aperture, "lens diameter [m]", With{.least = 0}},
        {"-c N", &c.repeat, "rays a pixel", With{.least = 1, .most = 1 << 30}},
        {"-i", &c.from_input, "read pixels' positions"},
        {"-u", ignored, "flush after each ray"},
        {"-d", &c.dimensions, "print the picture's size as options of rtrace"},
        {"-fF", AttachedOption{"-f", take_format}, "format of the rays: a, f or d"}};
    rows.insert(rows.end(), own.begin(), own.end());
    return rows;
}

/// The view of a picture, its size and the shape of its pixels.
void take_picture(VwraysCommand& command, FileSource& files) {
    const std::string bytes = files.read(command.picture);
    const InfoHeader header = decode_header(bytes, command.picture);
    read_view_file(bytes, command.picture, command.view);
    std::string_view rest = std::string_view(bytes).substr(header.size);
    const PictureResolution size = take_resolution(rest, command.picture);
    command.x = size.width;
    command.y = size.height;
    command.pixel_aspect = 0;  // the picture is as it is
}

class RayWriter {
  public:
    RayWriter(const VwraysCommand& command, const Camera& camera, const PictureSize& size)
        : command_(command), camera_(camera), size_(size) {}

    /// Rays of the pixel whose lower left corner is at (x, y), counted from the lower left.
    void pixel(double x, double y) {
        for (int i = 0; i < command_.repeat; ++i) {
            const auto place = [&] {
                return .5 + command_.jitter * (.5 - (command_.jitter > 0 ? random_.next() : .5));
            };
            const double h = (x + place()) / size_.width, v = (y + place()) / size_.height;
            put(camera_.ray(h, v));
        }
    }
    void flush() {
        write_to_stdout(bytes_);
        bytes_.clear();
    }

  private:
    void put(std::optional<Camera::ViewRay> ray) {
        constexpr std::size_t kEnoughBytes = std::size_t{1} << 16;
        if (!ray) ray = Camera::ViewRay{};
        if (command_.aperture > 0) open_aperture(*ray);
        // The limit is told by the direction's length, for -ld+.
        const double length = command_.view.aft > kEpsilon ? ray->limit : 1;
        const Vec3 d = ray->direction * length;
        const double numbers[] = {ray->origin.x, ray->origin.y, ray->origin.z, d.x, d.y, d.z};
        if (command_.format == 'a') {
            char line[128];
            std::snprintf(line, sizeof line, "%.5e %.5e %.5e %.5e %.5e %.5e\n", numbers[0],
                          numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]);
            bytes_ += line;
        }
        for (const double number : numbers) {
            if (command_.format == 'd') append(number);
            if (command_.format == 'f') append(static_cast<float>(number));
        }
        if (bytes_.size() >= kEnoughBytes) flush();
    }
    template <class Number>
    void append(Number number) {
        bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
    /// From a place of the lens to the place in focus.
    void open_aperture(Camera::ViewRay& ray) {
        if (length_squared(ray.direction) == 0) return;
        const double radius = command_.aperture / 2 * std::sqrt(random_.next());
        const double angle = 2 * kPi * random_.next();
        const Vec3 focus = ray.origin + ray.direction * length(command_.view.direction);
        ray.origin = ray.origin + camera_.right() * (radius * std::cos(angle)) +
                     camera_.upward() * (radius * std::sin(angle));
        ray.direction = normalize(focus - ray.origin);
    }

    const VwraysCommand& command_;
    const Camera& camera_;
    PictureSize size_;
    RandomStream random_{0};
    std::string bytes_;
};

/// Whole numbers are pixels, which rays go through the middle of.
void write_positions(RayWriter& writer) {
    double x = 0, y = 0;
    while (std::cin >> x >> y) {
        const auto corner = [](double place) {
            return std::floor(place) == place ? place : place - .5;
        };
        writer.pixel(corner(x), corner(y));
    }
}

void write_all(RayWriter& writer, const PictureSize& size) {
    for (int y = size.height; y-- > 0;)
        for (int x = 0; x < size.width; ++x) writer.pixel(x, y);
}

}  // namespace

int run_vwrays(const std::string& name, const std::vector<std::string>& line,
               Communicator* /*ranks*/) {
    const std::shared_ptr<FileSource> files = real_files();
    VwraysCommand command;
    const OptionTable table({name, ~0U}, {vwrays_rows(command, files)});
    OptionWords words(line, files);
    while (words.at_option()) {
        if (words.option().starts_with('-')) {
            if (!table.take(words)) table.refuse(words);
        } else if (command.picture.empty()) {
            command.picture = words.option();
            words.skip(1);
        } else {
            throw UsageError("rays from the depths of a picture (" + words.option() +
                             ") are not supported: use rtrace -opN with the rays of the view");
        }
    }
    if (!command.picture.empty()) take_picture(command, *files);
    const Camera camera(command.view);
    const PictureSize size =
        fit_picture(command.x, command.y, camera.aspect(), command.pixel_aspect);
    if (command.dimensions) {
        std::printf("-x %d -y %d -ld%c\n", size.width, size.height,
                    command.view.aft > kEpsilon ? '+' : '-');
        return kSuccessStatus;
    }
    RayWriter writer(command, camera, size);
    command.from_input ? write_positions(writer) : write_all(writer, size);
    writer.flush();
    return kSuccessStatus;
}

}  // namespace lightwalk
