#pragma once
// The module that speaks MPI: what it is called, and its one function.
#include <string>

#include "parallel/comm/communicator.h"

namespace lightwalk {

inline constexpr const char* kMpiModule = "liblightwalk_mpi.so";
inline constexpr const char* kOpenMpiSymbol = "lightwalk_open_mpi";

/// Starts MPI with main's arguments; once in a process, by the thread that will use the
/// communicator. Null and the reason in `error` when that fails. The caller owns the result; its
/// destructor ends MPI, and waits for the other ranks to do the same.
using OpenMpi = Communicator* (*)(int* count, char*** words, std::string& error);

}  // namespace lightwalk
