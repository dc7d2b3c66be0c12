// lightwalk trace: single rays, as rtrace answers them.
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>

#include "apps/commands.h"
#include "apps/scene_session.h"
#include "apps/warnings.h"
#include "io/rays/ray_reader.h"
#include "io/rays/ray_records.h"
#include "io/rays/ray_tree.h"
#include "parallel/ray_list.h"

namespace lightwalk {
namespace {

constexpr const char* kProgram = "lightwalk trace";
constexpr std::size_t kBatch = 16384;  ///< rays read ahead when nobody asks for a flush

struct TraceCommand {
    CommonOptions common;
    RenderSettings settings = default_render_settings(OptionDefaults::rtrace);
    bool header = true;         ///< -h
    RayFormats formats;         ///< -f
    std::string letters = "v";  ///< -o
    TreeSelection tree;         ///< -te -ti -tE -tI
    ColorOutput color = ColorOutput::rgb;
    bool sensor = false;           ///< -I
    bool limit_by_length = false;  ///< -ld
    int x = 0, y = 0;              ///< -x -y
    bool show_defaults = false;
    std::string history;
};

const std::vector<std::string> kOwnNames{"-h",  "-I",  "-ld",  "-x",  "-y",    "-fa",
                                         "-ff", "-fd", "-fac", "-ov", "-pRGB", "-pXYZ",
                                         "-pY", "-pA", "-te",  "-ti", "-tE",   "-tI"};

bool parse_switch(OptionWords& words, TraceCommand& command) {
    for (const auto& [name, place] :
         {std::pair{"-h", &command.header}, std::pair{"-I", &command.sensor},
          std::pair{"-ld", &command.limit_by_length}}) {
        if (const std::optional<bool> value = words.toggle(name, *place)) {
            *place = *value;
            return true;
        }
    }
    return false;
}

std::optional<ColorOutput> color_output(const std::string& word) {
    if (word == "-pRGB") return ColorOutput::rgb;
    if (word == "-pXYZ") return ColorOutput::xyz;
    if (word == "-pY") return ColorOutput::luminance;
    if (word == "-pA") return ColorOutput::mean;
    if (word == "-pc") {
        throw UsageError(
            "option -pc converts to other primaries, which is not supported; the choices are "
            "-pRGB, -pXYZ, -pY and -pA");
    }
    return std::nullopt;
}

bool parse_tree_option(OptionWords& words, const LibraryPath& library, TreeSelection& tree) {
    const std::string word = words.option();
    if (word != "-te" && word != "-ti" && word != "-tE" && word != "-tI") return false;
    using Kind = TreeSelection::Kind;
    const Kind kind = word[2] == 'e' || word[2] == 'E' ? Kind::exclude : Kind::include;
    const std::string name = words.text();
    const bool is_file = word[2] == 'E' || word[2] == 'I';
    tree.add(kind, is_file ? names_in_file(name, library) : std::vector<std::string>{name});
    return true;
}

bool parse_own_option(OptionWords& words, TraceCommand& command) {
    const std::string word = words.option();
    if (word == "-x")
        command.x = words.integer();
    else if (word == "-y")
        command.y = words.integer();
    else if (const auto formats =
                 word.starts_with("-f") ? parse_ray_formats(word.substr(2)) : std::nullopt) {
        command.formats = *formats;
        words.skip(1);
    } else if (word.starts_with("-o")) {
        command.letters = word.substr(2);
        words.skip(1);
    } else if (const auto color = color_output(word)) {
        command.color = *color;
        words.skip(1);
    } else {
        return parse_switch(words, command);
    }
    return true;
}

TraceCommand parse_trace_command(const std::vector<std::string>& line) {
    TraceCommand command;
    const LibraryPath library = LibraryPath::from_environment();
    OptionWords words(line);
    while (words.at_option()) {
        if (words.option() == "-defaults") {
            command.show_defaults = true;
            return command;
        }
        if (words.option() == "-P" || words.option() == "-PP") {
            throw UsageError("option " + words.option() +
                             ": persistent processes are not supported");
        }
        if (parse_own_option(words, command) || parse_tree_option(words, library, command.tree) ||
            parse_render_option(words, library, command.settings) ||
            parse_common_option(words, command.common, command.settings)) {
            continue;
        }
        std::vector<std::string> names = render_option_names();
        names.insert(names.end(), kOwnNames.begin(), kOwnNames.end());
        refuse_option(words, std::move(names));
    }
    command.history = command_history("trace", words, command.common);
    return command;
}

std::string describe(const TraceCommand& c) {
    std::string text = option_line("-o" + c.letters, "output fields");
    text += option_line(option_text("-h", c.header), "output header");
    text += option_line(option_text("-I", c.sensor), "rays are points and normals: irradiance");
    text +=
        option_line(option_text("-ld", c.limit_by_length), "a direction's length limits its ray");
    text += option_line(option_text("-x", c.x), "flush interval");
    text += option_line(option_text("-y", c.y), "rows");
    text += describe_render_settings(c.settings);
    text += option_line(option_text("-n", c.common.workers), "threads");
    text += option_line("--seed " + std::to_string(c.settings.light.seed), "random seed");
    return text;
}

class TraceRun {
  public:
    explicit TraceRun(TraceCommand command)
        : command_(std::move(command)),
          warnings_(kProgram),
          reader_(STDIN_FILENO, command_.formats.input) {
        prepare_output();
        redirect_messages(command_.common, command_.history);
        warnings_.enable(command_.settings.warnings && !command_.common.quiet);
        check_render_settings(command_.settings);
        check();
        options_ = {shades() || command_.sensor, command_.sensor, command_.limit_by_length,
                    command_.settings.light.seed};
        if (!options_.shade) {  // nothing is lit: do not prepare light sources
            command_.settings.light.relays = 0;
            command_.settings.light.shadow_threshold = 0;
        }
    }

    int run() {
        session_ = std::make_unique<SceneSession>(command_.common, warnings_);
        session_->build(command_.settings);
        if (options_.shade) session_->warn_of_darkness();
        executor_ = make_executor(command_.common.executor, command_.common.workers);
        contexts_ = std::make_unique<WorkerContexts>(session_->tracer(), warnings_,
                                                     executor_->concurrency());
        if (tree_) {
            tree_->watch(session_->tracer());
            (*contexts_)[0].observer = &*tree_;
        }
        const Stopwatch watch;
        put_header();
        while (read_batch()) answer_batch();
        if (expected_ > 0 && read_ < expected_) warnings_.warn("unexpected EOF on input");
        flush();
        if (!command_.common.stats_file.empty()) save_statistics(watch.seconds());
        return kSuccessStatus;
    }

  private:
    void prepare_output() {
        const OutputFields fields = parse_output_fields(command_.letters);
        const NumberFormat format = command_.formats.output;
        if (!fields.record.empty() || !fields.has_tree())
            records_.emplace(fields.record, format, command_.color);
        if (!fields.has_tree()) return;
        tree_.emplace(fields, format, command_.color, command_.tree, command_.sensor);
        command_.common.workers = 1;  // trees are told one after the other
        command_.common.executor = ExecutorKind::serial;
    }

    [[nodiscard]] bool shades() const { return tree_ || records_->shades(); }

    void check() {
        settle_scene_files(command_.common, "the rays");
        const bool irradiance = command_.sensor || command_.settings.light.irradiance;
        if (irradiance && !shades())
            throw UsageError("-I+ and -i+ options require some value output");
        if (irradiance && records_ && records_->splits())
            warnings_.warn("-or -oR -ox -oX say nothing with -i or -I");
        if (records_ && records_->asks_for_coefficients())
            warnings_.warn("-oVW options require trace mode");
        if (tree_) check_coefficients();
        if (command_.y > 0) {
            expected_ =
                static_cast<std::uint64_t>(command_.y) *
                (command_.x > 1 && command_.y > 1 ? static_cast<std::uint64_t>(command_.x) : 1);
        }
    }

    /// Values from the cache or by differences are not the sum of what the rays brought.
    void check_coefficients() {
        const RenderOptions& light = command_.settings.light;
        const bool exact = light.ambient_bounces <= 0 ||
                           (light.ambient_accuracy <= kEpsilon && light.ambient_super_samples <= 0);
        if (!exact && tree_->asks_for_coefficients())
            warnings_.warn("-otV and -otW are only accurate with -aa 0 -as 0");
    }

    void put_header() {
        if (command_.header) {
            std::string text = "#?RADIANCE\n";
            for (const std::string& line :
                 history_header(session_->model->header, command_.history))
                text += line + '\n';
            for (const std::string& line : date_lines()) text += line + '\n';
            output_ += text;
            output_ += tree_ ? tree_->header_end(text.size()) : records_->header_end(text.size());
        }
        if (command_.x > 0 && command_.y > 0) {
            char line[64];
            std::snprintf(line, sizeof line, "-Y %8d +X %8d\n", command_.y, command_.x);
            output_ += line;
        }
        if (!output_.empty()) flush();
    }

    /// Read rays until the batch is full or an answer is due. False: there are no more.
    bool read_batch() {
        queries_.clear();
        flush_due_ = false;
        const std::size_t most = tree_ ? 1 : kBatch;  // trees may be large
        while (queries_.size() < most && !flush_due_ && (expected_ == 0 || read_ < expected_)) {
            const std::optional<InputRay> ray = reader_.next();
            if (!ray) break;
            queries_.push_back({ray->origin, ray->direction});
            ++read_;
            const bool row_ends = command_.x > 0 && ++in_row_ >= command_.x;
            if (row_ends) in_row_ = 0;
            // Who sends rays through a pipe and waits for answers does so at a row's end or with a
            // zero direction.
            flush_due_ = (ray->is_flush() || row_ends) && reader_.drained();
        }
        return !queries_.empty();
    }

    void answer_batch() {
        texts_.assign((queries_.size() + kRaysPerTask - 1) / kRaysPerTask, {});
        const Scene& scene = session_->scene();
        trace_ray_list(session_->tracer(), *contexts_, queries_, read_ - queries_.size(), options_,
                       *executor_, [&](std::size_t i, const Ray& ray, const Hit& first) {
                           const bool sensor =
                               options_.sensor && length_squared(queries_[i].direction) > 0;
                           std::string& text = texts_[i / kRaysPerTask];
                           if (tree_) text += tree_->take();
                           if (records_) records_->append({ray, first, sensor}, scene, text);
                       });
        for (const std::string& text : texts_) output_ += text;
        constexpr std::size_t kEnough = 1 << 16;
        if (flush_due_ || output_.size() >= kEnough) flush();
    }

    void flush() {
        const bool whole = std::fwrite(output_.data(), 1, output_.size(), stdout) == output_.size();
        if (!whole || std::fflush(stdout) != 0) throw InputError("cannot write standard output");
        output_.clear();
    }

    void save_statistics(double seconds) const {
        RunStatistics statistics;
        statistics.command = "trace";
        statistics.read_seconds = session_->read_seconds;
        statistics.build_seconds = session_->build_seconds;
        statistics.render_seconds = seconds;
        statistics.rays = contexts_->rays();
        statistics.ambient = contexts_->ambient();
        if (session_->ambient) {
            statistics.ambient_values = session_->ambient->size();
            statistics.ambient_bytes = session_->ambient->memory_bytes();
        }
        statistics.threads = executor_->concurrency();
        write_statistics(command_.common.stats_file, statistics);
    }

    TraceCommand command_;
    StderrWarnings warnings_;
    std::optional<RayRecords> records_;  ///< not with trees alone
    std::optional<RayTree> tree_;        ///< -ot -oT
    RayReader reader_;
    RayListOptions options_;
    std::unique_ptr<SceneSession> session_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<WorkerContexts> contexts_;
    std::vector<RayQuery> queries_;
    std::vector<std::string> texts_;  ///< answers, by task
    std::string output_;
    std::uint64_t read_ = 0, expected_ = 0;
    int in_row_ = 0;
    bool flush_due_ = false;
};

}  // namespace

int run_trace(const std::vector<std::string>& words, Transport* /*ranks*/) {
    TraceCommand command = parse_trace_command(words);
    if (command.show_defaults) {
        std::fputs(describe(command).c_str(), stdout);
        return kSuccessStatus;
    }
    return TraceRun(std::move(command)).run();
}

}  // namespace lightwalk
