#include "io/scene/sky_calls.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

#include "io/language/command_line.h"
#include "io/scene/command_runner.h"
#include "io/scene/scene_reader.h"

namespace lightwalk {
namespace {

std::vector<std::string> words_of(const SimpleCommand& command) {
    std::vector<std::string> words;
    for (const CommandWord& word : command) words.push_back(word.text);
    return words;
}

std::string shell_text(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : " ") + quoted_for_shell(word);
    return text;
}

/// Throws InputError where primitives that a sky consists of are other than skies are.
void check_part(const Model& model, const GeneratedPart& part) {
    if (!part.refusal.empty()) throw InputError(part.where, part.refusal);
    const auto check_reference = [&](std::int32_t reference) {
        if (reference >= 0 && reference < part.first_modifier)
            throw InputError(part.where, "the sky stands on modifiers of its own file");
    };
    for (std::int32_t i = part.first_modifier; i < part.last_modifier; ++i) {
        const Primitive& primitive = model.modifiers[static_cast<std::size_t>(i)];
        check_reference(primitive.modifier);
        for (const std::int32_t reference : primitive.references) check_reference(reference);
    }
    for (std::size_t i = part.first_surface; i < part.last_surface; ++i) {
        check_reference(model.surfaces.modifier(i));
        if (model.surfaces.type(i) != PrimitiveType::source)
            throw InputError(part.where, "the command writes more than a sky");
    }
}

/// The indices that new modifiers of a sky get: those of the old ones of the same names, in their
/// order; behind all others where there are none.
std::vector<std::int32_t> places_of(const std::vector<Primitive>& fresh, const GeneratedPart& part,
                                    std::vector<Primitive>& all) {
    std::vector<std::int32_t> places;
    std::map<std::string, std::int32_t> next;
    for (const Primitive& primitive : fresh) {
        std::int32_t& from = next.try_emplace(primitive.name, part.first_modifier).first->second;
        while (from < part.last_modifier &&
               all[static_cast<std::size_t>(from)].name != primitive.name)
            ++from;
        if (from < part.last_modifier) {
            places.push_back(from++);
        } else {
            places.push_back(static_cast<std::int32_t>(all.size()));
            all.emplace_back();
        }
    }
    return places;
}

}  // namespace

SkyCalls::SkyCalls(const Model& model, LibraryPath library)
    : model_(model), library_(std::move(library)) {
    try {
        for (const GeneratedPart& part : model.skies) {
            check_part(model, part);
            calls_.push_back(read(part));
        }
    } catch (const InputError& error) {
        refusal_ = error.what();
        calls_.clear();
    }
    if (!calls_.empty()) find_sources();
}

SkyCalls::Call SkyCalls::read(const GeneratedPart& part) const {
    const auto pipelines = split_command(without_command_mark(part.command));
    if (!pipelines || pipelines->size() != 1 ||
        !SkyCommand::is_sky(pipelines->front().front().front().text))
        throw InputError(part.where, "the command does more than to make a sky");
    const Pipeline& pipeline = pipelines->front();
    try {
        Call call{&part, SkyCommand(words_of(pipeline.front())), {}};
        for (std::size_t i = 1; i < pipeline.size(); ++i)
            call.pipe.push_back(words_of(pipeline[i]));
        return call;
    } catch (const InputError& error) {
        throw InputError(part.where, error.what());
    }
}

/// In one walk along the surfaces, of which there may be millions.
void SkyCalls::find_sources() {
    std::size_t sources = 0, others = 0;
    const auto mark = [&](std::size_t i) {
        for (Call& call : calls_) {
            if (call.part->first_surface == i) {
                call.first_source = sources;
                call.before = others;
            }
            if (call.part->last_surface == i) call.last_source = sources;
        }
    };
    for (std::size_t i = 0; i < model_.surfaces.size(); ++i) {
        mark(i);
        ++(model_.surfaces.type(i) == PrimitiveType::source ? sources : others);
    }
    mark(model_.surfaces.size());
}

bool SkyCalls::has_types() const {
    return std::ranges::any_of(calls_, [](const Call& call) { return call.command.has_types(); });
}

std::string SkyCalls::run(const Call& call, const SkyTime& time) const {
    std::string command = shell_text(call.command.at(time));
    for (const std::vector<std::string>& stage : call.pipe) command += " | " + shell_text(stage);
    NoWarnings quiet;
    return CommandRunner(library_, false, quiet).run(command, "", call.part->where);
}

std::string SkyCalls::text(const SkyTime& time) const {
    std::string text;
    for (const Call& call : calls_) text += run(call, time);
    return text;
}

void SkyCalls::apply(const SkyTime& time, ModelChange& change) const {
    // Places among the sources are those of before: from the last one to the first.
    for (auto call = calls_.rbegin(); call != calls_.rend(); ++call) {
        NoWarnings quiet;
        const std::shared_ptr<const Model> fresh = parse_scene(
            run(*call, time), call->part->command, {library_, false, {}, {}, {}}, quiet);
        const std::vector<std::int32_t> places =
            places_of(fresh->modifiers, *call->part, change.modifiers);
        const auto placed = [&](std::int32_t index) {
            return index < 0 ? index : places[static_cast<std::size_t>(index)];
        };
        for (std::size_t i = 0; i < places.size(); ++i) {
            Primitive primitive = fresh->modifiers[i];
            primitive.modifier = placed(primitive.modifier);
            for (std::int32_t& reference : primitive.references) reference = placed(reference);
            primitive.where = call->part->where;
            change.modifiers[static_cast<std::size_t>(places[i])] = std::move(primitive);
        }
        std::vector<PlacedSource> suns;
        for (PlacedSource& sun : unchanged(*fresh).sources) {
            sun.before = call->before;
            sun.source.modifier = placed(sun.source.modifier);
            sun.source.where = call->part->where;
            suns.push_back(std::move(sun));
        }
        const auto first = change.sources.begin() + static_cast<std::ptrdiff_t>(call->first_source);
        const auto last = change.sources.begin() + static_cast<std::ptrdiff_t>(call->last_source);
        change.sources.insert(change.sources.erase(first, last),
                              std::make_move_iterator(suns.begin()),
                              std::make_move_iterator(suns.end()));
    }
}

}  // namespace lightwalk
