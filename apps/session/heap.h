#pragma once
// The process's memory, arranged for scenes.

namespace lightwalk {

/// Ask for large pages under the first 32 MB of the heap, and let it hold all but the largest
/// arrays: a scene is built of hundreds of thousands of pieces, and where pages of 4 kB are first
/// touched takes a good part of that time, on virtual machines above all. Once, while there is one
/// thread. A hint: where the system has no such pages, or another allocator stands in, nothing
/// changes.
void prepare_heap();

/// Give the system what is free of the heap, now and from now on. Before and after a large scene is
/// built: what was needed for that is not needed again, and each rank of a machine would hold it.
void give_back_heap();

}  // namespace lightwalk
