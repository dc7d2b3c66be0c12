// lightwalk install-names: a folder of links by the names of Radiance's programs.
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "apps/commands.h"
#include "apps/names/named_program.h"
#include "core/error.h"

namespace lightwalk {
namespace {

namespace fs = std::filesystem;

constexpr const char* kServed = "rtrace";  ///< the name of which servers take the work

struct InstallNamesCommand {
    bool serve = false;  ///< --serve
};

OptionTable install_names_table(InstallNamesCommand& command) {
    const Action answered{[] {}};  // by main
    return {
        {"install-names", kInstallNames},
        {{{"--serve", &command.serve,
           "rtrace asks the server of its octree (`lightwalk trace --serve`), and starts one at "
           "the second run on it: for thousands of runs with a few rays each"}},
         {{"Help", SectionTitle{}},
          {"--help", answered, "this text"},
          {"--version", answered, "the version of Lightwalk"}}}};
}

/// Where a link in `folder` finds the program: relative where both lie below one folder that is
/// more than the root, so that they can be moved together.
fs::path target_from(const fs::path& folder, const fs::path& program) {
    const fs::path relative = program.lexically_relative(folder);
    const auto first = [](const fs::path& path) { return *std::next(path.begin()); };
    return !relative.empty() && first(folder) == first(program) ? relative : program;
}

/// A name that is there already is replaced where it is a link.
void make_link(const fs::path& link, const fs::path& target) {
    std::error_code error;
    const fs::file_status there = fs::symlink_status(link, error);
    if (fs::exists(there) && !fs::is_symlink(there))
        throw InputError({link.string(), 0}, "is there already, and is no link");
    // Renamed over the old link, so that the name never is missing for those who use it.
    const fs::path fresh = link.string() + ".new";
    fs::remove(fresh, error);
    fs::create_symlink(target, fresh, error);
    if (!error) fs::rename(fresh, link, error);
    if (error) throw InputError({link.string(), 0}, "cannot make the link: " + error.message());
}

}  // namespace

OptionTable install_names_option_table() {
    return owning_table(InstallNamesCommand(), install_names_table);
}

int run_install_names(const std::vector<std::string>& words, Communicator* /*ranks*/) {
    const bool serve = !words.empty() && words[0] == "--serve";
    const std::string name = words.size() == (serve ? 2U : 1U) ? words.back() : "";
    if (name.empty() || name[0] == '-') throw UsageError("expected one folder for the links");
    std::error_code error;
    fs::create_directories(name, error);
    if (error) throw InputError({name, 0}, "cannot make the folder: " + error.message());
    const fs::path folder = fs::canonical(name, error);
    const fs::path program = fs::canonical("/proc/self/exe", error);
    if (error) throw InputError("cannot tell where this program is: " + error.message());
    const fs::path asking = program.parent_path() / "lightwalk-served";
    if (serve && !fs::exists(asking, error))
        throw InputError({asking.string(), 0}, "is missing: it is what asks a server");
    for (const NamedProgram& named : named_programs()) {
        if (program == folder / named.name)
            throw InputError({(folder / named.name).string(), 0}, "is the program itself");
        make_link(folder / named.name,
                  target_from(folder,
                              serve && std::string_view(named.name) == kServed ? asking : program));
    }
    std::printf("%zu names in %s: put it before Radiance's folder on the PATH\n",
                named_programs().size(), folder.c_str());
    return kSuccessStatus;
}

}  // namespace lightwalk
