#pragma once
// Parses the command line of xform: options, arrays (-a) and argument files (-f) become a list of
// single transformations.
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/generators/xform_primitive.h"

namespace lightwalk {

struct XformCommandLine {
    std::vector<std::string> options;  ///< as given, with -a and -f
    std::vector<std::string> files;    ///< scene files; a "" is standard input
    bool keep_commands = false;        ///< -c: pass commands on instead of running them
};

/// Divide args (args[0] is the program) into options and files. Throws InputError "command line
/// error at ...".
[[nodiscard]] XformCommandLine parse_xform(std::span<const std::string> args);

/// The words of each line of an argument file: blank lines and comments are skipped, a leading '!'
/// and a leading "xform" are dropped, quotes group words, backslash-newline continues a line.
[[nodiscard]] std::vector<std::vector<std::string>> read_argument_lines(const std::string& text);

/// Call `apply` for every transformation that `options` ask for, in order: for each line of -f, and
/// for each element of the arrays -a, of which the first varies slowest. `read` returns the text of
/// an argument file. Throws InputError for bad options, and for arrays that have more than a
/// million elements or nest more than 64 deep.
void for_each_step(const std::vector<std::string>& options,
                   const std::function<std::string(const std::string& file)>& read,
                   const std::function<void(const XformStep& step)>& apply);

}  // namespace lightwalk
