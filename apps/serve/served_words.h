#pragma once
// What the server of a scene and the small program that asks it agree on. Without C++'s library,
// which would take longer to load than the program runs.
#include <cstddef>
#include <cstdint>

namespace lightwalk {

inline constexpr std::size_t kMostRequest = std::size_t{128} << 10;  ///< bytes; longer: nobody asks
inline constexpr std::size_t kMostServedPath = 100;                  ///< bytes of a socket's path
inline constexpr int kServedStreams = 3;  ///< standard input, output and error

/// For a server: what it forks has no symbols to look up.
inline constexpr char kBindAtOnce[] = "LD_BIND_NOW=1";

/// What makes a scene another one, as bytes: the program, the folder, the word that names the
/// octree, where files are looked for, and which processes share memory and processors with the one
/// that asks. Who has the same bytes reads the same scene, as long as
/// its files are the same.
struct SceneKey {
    char bytes[8192];
    std::size_t size = 0;
    std::uint64_t hash = 0;  ///< of the bytes
};

/// @param program      path of lightwalk
/// @param scene        the word as it stands on the command line
/// @param environment  ends with null
/// @return  false: there is none, as some of it is missing or too long
bool make_scene_key(const char* program, const char* scene, char* const* environment,
                    SceneKey& key);

/// Path of lightwalk, which lies beside the program that runs. False: it cannot be told.
bool find_lightwalk(char* path, std::size_t size);

/// The user's folder for sockets: of XDG_RUNTIME_DIR, or of /tmp. False: its path is too long.
bool served_folder(char* const* environment, char (&path)[kMostServedPath]);
/// Whether the folder is there (made where it is missing), is the user's and is open to nobody
/// else.
bool make_served_folder(const char* path);
/// The table in it of octrees that have been traced in, open; -1: it cannot be written to.
int open_served_table(const char* folder);
/// FOLDER/HASH. False: it is too long.
bool served_path(const char* folder, std::uint64_t hash, char (&path)[kMostServedPath]);

/// Begins a request; behind it are the key, then the words and the environment, each text with a
/// zero behind it. With it go standard input, output and error, and the current directory.
struct RequestHead {
    char magic[8] = {'L', 'W', 's', 'e', 'r', 'v', 'e', '1'};
    std::uint32_t key = 0;                   ///< bytes
    std::uint32_t words = 0, variables = 0;  ///< texts
    std::uint32_t mask = 0;                  ///< of the modes of files that are made (umask)
    std::uint64_t ignored = 0;               ///< signals, 1 in the lowest bit
    std::uint64_t blocked = 0;
};

/// What the server sends: first `begun` or `declined`, then how it ended.
struct ServedReply {
    enum Kind : std::int32_t { begun, declined, exited, killed };
    std::int32_t kind = declined;
    std::int32_t value = 0;  ///< exit status, or signal
};

}  // namespace lightwalk
