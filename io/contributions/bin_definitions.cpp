#include "io/contributions/bin_definitions.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

constexpr std::size_t kLargestDefinitions = std::size_t{16} << 20;  // [bytes]
constexpr double kMostBins = 1e6;
constexpr const char* kHere = ".";  ///< the context of all definitions

ChannelMask known_channels() {
    ChannelMask mask = 0;
    for (const Channel c :
         {Channel::Dx, Channel::Dy, Channel::Dz, Channel::Px, Channel::Py, Channel::Pz})
        mask |= channel_bit(c);
    return mask;
}

double& channel(ChannelValues& values, Channel c) {
    return values[static_cast<std::size_t>(c)];
}

}  // namespace

void BinDefinitions::add(Definitions definitions) {
    FunctionEnvironment trial = environment("");  // constants are evaluated at once
    trial.define(definitions.text, definitions.where);
    definitions_.push_back(std::move(definitions));
}

void BinDefinitions::add_expression(const std::string& text) {
    add({text, {"option -e", 0}});
}

void BinDefinitions::add_file(const std::string& name, const LibraryPath& library) {
    const std::string path = library.locate(name, "function file");
    add({library.files().read(path, kLargestDefinitions), {path, 1}});
}

FunctionEnvironment BinDefinitions::environment(const std::string& parameters) const {
    FunctionEnvironment environment;
    for (const Definitions& definitions : definitions_)
        environment.define(definitions.text, definitions.where);
    if (parameters.empty()) return environment;
    std::string text = parameters;
    int depth = 0;  // of parentheses, in which commas separate arguments
    for (char& c : text) {
        depth += c == '(' ? 1 : c == ')' ? -1 : 0;
        if (c == ',' && depth == 0) c = ';';
    }
    environment.define(text + ';', {"option -p", 0});
    return environment;
}

Program BinDefinitions::bin(const std::string& expression, const std::string& parameters) const {
    const SourceLocation where{"option -b \"" + expression + '"', 0};
    const ExpressionRequest request{expression, -1};
    Program program = environment(parameters).compile(kHere, {&request, 1}, {}, 0, where);
    if ((program.channels() & ~known_channels()) != 0)
        throw InputError(where, "a bin may depend on Px Py Pz and Dx Dy Dz alone");
    // Names that are not defined show when they are needed.
    (void)BinChooser().choose(program, {0, 0, 1}, {});
    return program;
}

int BinDefinitions::count(const std::string& expression, const std::string& parameters) const {
    const SourceLocation where{"option -bn \"" + expression + '"', 0};
    const ExpressionRequest request{expression, -1};
    const Program program = environment(parameters).compile(kHere, {&request, 1}, {}, 0, where);
    EvalState state;
    const ChannelValues channels{};
    program.begin(state, channels);
    const double value = std::floor(program.evaluate(0, state) + 0.5);
    if (!(value >= 1 && value <= kMostBins))
        throw InputError(where, "illegal number of bins, expected 1 to 1000000");
    return static_cast<int>(value);
}

bool depends_on_position(const Program& bin) {
    ChannelMask position = 0;
    for (const Channel c : {Channel::Px, Channel::Py, Channel::Pz}) position |= channel_bit(c);
    return (bin.channels() & position) != 0;
}

std::optional<std::size_t> BinChooser::choose(const Program& bin, const Vec3& direction,
                                              const Vec3& position) {
    channel(channels_, Channel::Dx) = direction.x;
    channel(channels_, Channel::Dy) = direction.y;
    channel(channels_, Channel::Dz) = direction.z;
    channel(channels_, Channel::Px) = position.x;
    channel(channels_, Channel::Py) = position.y;
    channel(channels_, Channel::Pz) = position.z;
    bin.begin(state_, channels_);
    const double value = std::floor(bin.evaluate(0, state_) + 0.5);
    if (!(value >= 0 && value < 2 * kMostBins)) return std::nullopt;
    return static_cast<std::size_t>(value);
}

}  // namespace lightwalk
