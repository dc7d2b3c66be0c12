#include "io/generators/scene_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "io/generators/generator.h"
#include "io/language/number_text.h"

namespace lightwalk {
namespace {

std::string number(double value, std::chars_format format, int digits) {
    std::array<char, 400> text{};  // the largest double has 309 digits before the point
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format, digits);
    return {text.data(), end.ptr};
}

}  // namespace

SceneWriter::SceneWriter(std::span<const std::string> args, TextSink* sink)
    : program_(args[0]), sink_(sink), out_(command_comment(args)) {}

void SceneWriter::write(std::string_view modifier, std::string_view type, std::string_view name,
                        std::span<const double> reals) {
    write(modifier, type, name, reals, {});
}

void SceneWriter::write(std::string_view modifier, std::string_view type, std::string_view name,
                        std::span<const double> reals, std::span<const std::string> strings) {
    for (const double real : reals) {
        if (!std::isfinite(real)) {
            throw InputError(program_ + ": " + std::string(type) + " \"" + std::string(name) +
                             "\" has a coordinate that is not a finite number");
        }
    }
    primitive_.modifier = modifier;
    primitive_.type_word = type;
    primitive_.name = name;
    primitive_.strings.assign(strings.begin(), strings.end());
    primitive_.reals.assign(reals.begin(), reals.end());
    write_primitive(primitive_, kFullDigits, out_);
    check_size();
}

void SceneWriter::polygon(std::string_view modifier, std::string_view name,
                          std::span<const Vec3> vertices) {
    std::vector<double> reals;
    reals.reserve(3 * vertices.size());
    for (const Vec3& p : vertices) reals.insert(reals.end(), {p.x, p.y, p.z});
    write(modifier, "polygon", name, reals);
}

void SceneWriter::polygon(std::string_view modifier, std::string_view name,
                          std::span<const std::string_view> vertices) {
    out_.push_back('\n');
    append_word(modifier, out_);
    out_ += " polygon ";
    append_word(name, out_);
    out_ += "\n0\n0\n";
    out_ += std::to_string(3 * vertices.size());
    for (const std::string_view vertex : vertices) out_ += vertex;
    out_.push_back('\n');
    check_size();
}

void SceneWriter::sphere(std::string_view modifier, std::string_view name, const Vec3& center,
                         double radius) {
    write(modifier, "sphere", name, std::array{center.x, center.y, center.z, radius});
}

void SceneWriter::cylinder(std::string_view modifier, std::string_view name, const Vec3& p,
                           const Vec3& q, double radius) {
    write(modifier, "cylinder", name, std::array{p.x, p.y, p.z, q.x, q.y, q.z, radius});
}

void SceneWriter::text(std::string_view text) {
    out_ += text;
    check_size();
}

/// Hands over a piece when it is long enough.
void SceneWriter::check_size() {
    const std::size_t most = sink_ == nullptr ? kMaxGeneratedBytes : kMaxStreamedBytes;
    if (handed_over_ + out_.size() > most) throw InputError(program_ + ": too much output");
    if (sink_ == nullptr || out_.size() < kPieceBytes) return;
    sink_->push(out_);
    handed_over_ += out_.size();
    out_.clear();
}

void append_vertex(const Vec3& vertex, std::string& out) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.push_back(axis == 0 ? '\n' : ' ');
        append_real(vertex[axis], kFullDigits, out);
    }
}

std::string command_comment(std::span<const std::string> args) {
    std::string line = "#";
    for (const std::string& word : args) line += " " + quoted_for_shell(word);
    std::ranges::replace(line, '\n', ' ');
    std::ranges::replace(line, '\r', ' ');
    return line + "\n";
}

std::string general(double value, int digits) {
    return number(value, std::chars_format::general, digits);
}
std::string fixed(double value, int decimals) {
    return number(value, std::chars_format::fixed, decimals);
}
std::string scientific(double value, int decimals) {
    return number(value, std::chars_format::scientific, decimals);
}

}  // namespace lightwalk
