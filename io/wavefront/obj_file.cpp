#include "io/wavefront/obj_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/error.h"
#include "core/model/transform_args.h"
#include "io/formats/words.h"

namespace lightwalk {
namespace {

constexpr double kLargestCoordinate = 1e20;

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string& name) : rest_(text), where_{name, 0} {}

    ObjFile read() {
        while (!rest_.empty()) {
            std::string_view line = next_line();
            const std::string_view statement = take_word(line);
            if (statement == "v")
                file_.positions.push_back(read_vector(line, "a vertex"));
            else if (statement == "vn")
                file_.normals.push_back(read_normal(line));
            else if (statement == "vt")
                read_uv(line);
            else if (statement == "f")
                read_face(line);
            else
                read_name(statement, without_blanks(line));
        }
        return std::move(file_);
    }

  private:
    /// The next line, with those that it continues on after a backslash.
    std::string_view next_line() {
        ++where_.line;
        line_ = where_.line;
        std::string_view line = take_line(rest_);
        if (!line.ends_with('\\')) return line;
        joined_.clear();
        while (line.ends_with('\\') && !rest_.empty()) {
            joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
            ++where_.line;
            line = take_line(rest_);
        }
        return joined_.append(line);
    }

    [[nodiscard]] InputError error(const std::string& problem) const {
        return {{where_.file, line_}, problem};
    }

    double read_number(std::string_view& line, const char* of) {
        const std::string_view word = take_word(line);
        double value = 0;
        if (!parse_real(word, value) || !(std::abs(value) <= kLargestCoordinate))
            throw error("bad number \"" + std::string(word) + "\" of " + of);
        return value;
    }

    Vec3 read_vector(std::string_view& line, const char* of) {
        const double x = read_number(line, of), y = read_number(line, of);
        return {x, y, read_number(line, of)};
    }

    Vec3 read_normal(std::string_view& line) {
        const Vec3 normal = normalize(read_vector(line, "a normal"));
        if (normal == Vec3{}) throw error("a normal of no length");
        return normal;
    }

    void read_uv(std::string_view& line) {
        const double u = read_number(line, "a texture coordinate");
        const bool has_v = !without_blanks(line).empty();  // a curve's texture has one
        file_.uvs.push_back({u, has_v ? read_number(line, "a texture coordinate") : 0});
    }

    void read_face(std::string_view& line) {
        ObjFile::Face face = current_;
        face.first = static_cast<std::uint32_t>(file_.corners.size());
        face.line = line_;
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            if (word.front() == '#') break;
            file_.corners.push_back(read_corner(word));
        }
        if (file_.corners.size() >= ObjFile::kNone) throw error("too many corners");
        face.count = static_cast<std::uint32_t>(file_.corners.size()) - face.first;
        if (face.count < 3)
            throw error("a face of " + std::to_string(face.count) +
                        " vertices, expected at least 3");
        file_.faces.push_back(face);
    }

    /// position[/[uv][/[normal]]]
    ObjFile::Corner read_corner(std::string_view word) {
        const std::string_view all = word;
        const auto part = [&word] {
            const std::size_t end = std::min(word.find('/'), word.size());
            const std::string_view result = word.substr(0, end);
            word.remove_prefix(std::min(end + 1, word.size()));
            return result;
        };
        const auto index = [&](std::size_t count, const char* what) {
            return resolve(part(), count, what, all);
        };
        ObjFile::Corner corner;
        corner.position = index(file_.positions.size(), "vertex");
        corner.uv = index(file_.uvs.size(), "texture coordinate");
        corner.normal = index(file_.normals.size(), "normal");
        if (corner.position == ObjFile::kNone || !word.empty())
            throw error("bad corner \"" + std::string(all) + "\" of a face, expected v/vt/vn");
        return corner;
    }

    /// Positive indices count from 1, negative ones from the last; "" and 0 are none.
    std::uint32_t resolve(std::string_view word, std::size_t count, const char* what,
                          std::string_view corner) const {
        if (word.empty()) return ObjFile::kNone;
        long long index = 0;
        const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (code != std::errc() || end != word.data() + word.size())
            throw error("bad corner \"" + std::string(corner) + "\" of a face, expected v/vt/vn");
        if (index == 0) return ObjFile::kNone;
        const auto most = static_cast<long long>(count);
        if (index > most || index < -most)
            throw error("corner \"" + std::string(corner) + "\" of a face: there is no " + what +
                        " " + std::to_string(index) + ", there are " + std::to_string(count));
        return static_cast<std::uint32_t>(index > 0 ? index - 1 : most + index);
    }

    void read_name(std::string_view statement, std::string_view text) {
        if (statement == "usemtl") {
            if (text.empty()) return;
            current_.material = number_of(text);
            file_.material_names.emplace(text);
        } else if (statement == "usemap") {
            if (!text.empty() && text != "off") file_.map_names.emplace(text);
        } else if (statement == "g") {
            current_.groups = text.empty() ? ObjFile::kNone : number_of(text);
            if (!text.empty()) file_.group_names.emplace(text);
            const std::string_view group = take_word(text);
            current_.group = group.empty() ? ObjFile::kNone : number_of(group);
        } else if (statement == "o") {
            current_.object = text.empty() ? ObjFile::kNone : number_of(text);
            if (!text.empty()) file_.object_names.emplace(text);
        } else if (statement == "mtllib" && !text.empty()) {
            file_.libraries.emplace_back(text);
        }
    }

    std::uint32_t number_of(std::string_view name) {
        const auto [at, is_new] =
            numbers_.try_emplace(std::string(name), static_cast<std::uint32_t>(file_.names.size()));
        if (is_new) file_.names.emplace_back(name);
        return at->second;
    }

    std::string_view rest_;
    std::string joined_;
    SourceLocation where_;
    std::int32_t line_ = 0;  ///< at which the statement begins
    ObjFile::Face current_;  ///< the names that the next face has
    std::unordered_map<std::string, std::uint32_t> numbers_;
    ObjFile file_;
};

}  // namespace

const std::string& ObjFile::material_of(const Face& face) const {
    static const std::string kNoName;
    const std::uint32_t name = face.material != kNone ? face.material : face.group;
    return name == kNone ? kNoName : names[name];
}

ObjFile decode_obj(std::string_view text, const std::string& name) {
    return ObjReader(text, name).read();
}

}  // namespace lightwalk
