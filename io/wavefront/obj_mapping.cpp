#include "io/wavefront/obj_mapping.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <utility>

#include "core/error.h"
#include "io/formats/words.h"

namespace lightwalk {
namespace {

using Qualifier = ObjRule::Qualifier;

constexpr std::array<std::pair<std::string_view, Qualifier>, 5> kQualifiers = {
    {{"Material", Qualifier::material},
     {"Map", Qualifier::map},
     {"Group", Qualifier::group},
     {"Object", Qualifier::object},
     {"Face", Qualifier::face}}};

class MappingReader {
  public:
    MappingReader(std::string_view text, const std::string& name) : rest_(text), where_{name, 1} {}

    std::vector<ObjRule> read() {
        std::vector<ObjRule> rules;
        for (skip(); !rest_.empty(); skip()) {
            ObjRule& rule = rules.emplace_back();
            rule.material = word(" \t\r\n();#");
            if (rule.material.empty()) fail("found \"" + next() + "\", expected a material");
            for (skip(); rest_.starts_with('('); skip()) add_condition(rule);
            if (!rest_.empty() && !take(';')) fail("found \"" + next() + "\", expected ( or ;");
        }
        return rules;
    }

  private:
    [[noreturn]] void fail(const std::string& problem) const { throw InputError(where_, problem); }

    [[nodiscard]] std::string next() const {
        return std::string(rest_.substr(0, rest_.find_first_of(" \t\r\n")));
    }

    /// Blanks, and comments to the end of their line.
    void skip() {
        while (!rest_.empty()) {
            const char c = rest_.front();
            if (c == '#') {
                rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
                continue;
            }
            if (c != ' ' && c != '\t' && c != '\r' && c != '\n') return;
            if (c == '\n') ++where_.line;
            rest_.remove_prefix(1);
        }
    }

    std::string word(const char* ends) {
        std::string text(rest_.substr(0, rest_.find_first_of(ends)));
        rest_.remove_prefix(text.size());
        return text;
    }

    bool take(char c) {
        skip();
        if (!rest_.starts_with(c)) return false;
        rest_.remove_prefix(1);
        return true;
    }

    void add_condition(ObjRule& rule) {
        (void)take('(');
        skip();
        const std::string name = word(" \t\r\n()[\";");
        const auto known = std::ranges::find(kQualifiers, std::string_view(name),
                                             &std::pair<std::string_view, Qualifier>::first);
        if (known == kQualifiers.end())
            fail("unknown qualifier \"" + name +
                 "\", expected Material, Map, Group, Object or Face");
        if (std::ranges::find(rule.conditions, known->second, &ObjRule::Condition::qualifier) !=
            rule.conditions.end())
            fail("a second condition on " + name + " in one rule");
        ObjRule::Condition condition{known->second, {}};
        read_value(condition);
        if (!take(')')) fail("found \"" + next() + "\", expected )");
        rule.conditions.push_back(std::move(condition));
    }

    void read_value(ObjRule::Condition& condition) {
        if (take('"')) {
            condition.value = word("\"\n");
            if (condition.value.empty() || !rest_.starts_with('"'))
                fail("bad text of a condition, expected \"text\"");
            rest_.remove_prefix(1);
        } else if (take('[')) {
            condition.low = number();
            if (!take(':')) fail("bad range of a condition, expected [low:high]");
            condition.high = number();
            if (!take(']')) fail("bad range of a condition, expected [low:high]");
            if (condition.high < condition.low)
                fail("a range whose end comes before its beginning");
        } else {
            condition.low = condition.high = number();
        }
    }

    std::int64_t number() {
        skip();
        std::int64_t value = 0;
        const auto [end, code] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (code != std::errc())
            fail("found \"" + next() + "\", expected \"text\", a number or [low:high]");
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return value;
    }

    std::string_view rest_;
    SourceLocation where_;
};

/// The names that one statement lists.
std::vector<std::string_view> words_of_name(std::string_view text) {
    std::vector<std::string_view> words;
    for (std::string_view word = take_word(text); !word.empty(); word = take_word(text))
        words.push_back(word);
    return words;
}

std::string_view name_of(const ObjFile& file, std::uint32_t index) {
    return index == ObjFile::kNone ? std::string_view() : std::string_view(file.names[index]);
}

/// Names match a text; a number matches names that are this number.
bool matches(const ObjRule::Condition& condition, std::string_view name) {
    if (condition.high < condition.low) return name == condition.value;
    std::int64_t value = 0;
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), value);
    return !name.empty() && code == std::errc() && end == name.data() + name.size() &&
           value >= condition.low && value <= condition.high;
}

bool meets(const ObjRule::Condition& condition, const ObjFile& file, const ObjFile::Face& face,
           std::size_t number) {
    switch (condition.qualifier) {
        case Qualifier::material: {
            std::string_view name = name_of(file, face.material);
            return matches(condition, take_word(name));
        }
        case Qualifier::group:
            return std::ranges::any_of(
                words_of_name(name_of(file, face.groups)),
                [&](std::string_view group) { return matches(condition, group); });
        case Qualifier::object: {
            std::string_view name = name_of(file, face.object);
            return matches(condition, take_word(name));
        }
        case Qualifier::face: {
            const auto n = static_cast<std::int64_t>(number);
            return n >= condition.low && n <= condition.high;
        }
        case Qualifier::map:
            break;
    }
    return false;
}

void list_qualifier(const char* qualifier, const std::set<std::string_view>& values,
                    std::string& out) {
    if (values.empty()) return;
    out += std::string("qualifier ") + qualifier + " begin\n";
    for (const std::string_view value : values) out.append("\"").append(value).append("\"\n");
    out += "end\n";
}

}  // namespace

std::vector<ObjRule> decode_obj_mapping(std::string_view text, const std::string& name) {
    return MappingReader(text, name).read();
}

std::optional<std::string> mapped_material(const std::vector<ObjRule>& rules, const ObjFile& file,
                                           const ObjFile::Face& face, std::size_t number) {
    const auto rule = std::find_if(rules.rbegin(), rules.rend(), [&](const ObjRule& r) {
        return std::ranges::all_of(r.conditions, [&](const ObjRule::Condition& condition) {
            return meets(condition, file, face, number);
        });
    });
    if (rule == rules.rend() || rule->material == "void") return std::nullopt;
    return rule->material;
}

std::string obj_qualifiers(const ObjFile& file, const std::string& name) {
    std::set<std::string_view> materials, maps, groups, objects;
    for (std::string_view text : file.material_names) materials.insert(take_word(text));
    for (std::string_view text : file.map_names) maps.insert(take_word(text));
    for (const std::string_view text : file.group_names)
        for (const std::string_view group : words_of_name(text)) groups.insert(group);
    for (std::string_view text : file.object_names) objects.insert(take_word(text));
    std::string out = "filename \"" + name + "\"\nfiletype \"Wavefront\"\n";
    list_qualifier("Material", materials, out);
    list_qualifier("Map", maps, out);
    list_qualifier("Group", groups, out);
    list_qualifier("Object", objects, out);
    return out + "qualifier Face begin\n[1:" + std::to_string(file.faces.size()) + "]\nend\n";
}

}  // namespace lightwalk
