#pragma once
// Standard output of a process that mpirun has started.

namespace lightwalk {

/// mpirun gives its processes a terminal or a pipe as standard output, whose other end it copies to
/// its own; where it cannot write all of it (a full disk), it says nothing, and the process that
/// wrote it hears nothing. So what mpirun writes to becomes the standard output of this process, if
/// mpirun is its parent: on the host where it was called. Standard output that was redirected
/// behind mpirun stays as it is.
/// @return  false: mpirun, or another program like it, still stands between
[[nodiscard]] bool write_past_launcher();

}  // namespace lightwalk
