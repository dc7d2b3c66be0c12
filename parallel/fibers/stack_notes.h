#pragma once
// Annotations that tell the sanitizers when execution switches to a fiber's stack, which they would
// report as errors otherwise. Empty in other builds.
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#elif defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace lightwalk {

#if defined(__SANITIZE_ADDRESS__)

class AddressNotes {
  public:
    /// Clear AddressSanitizer's marks of a stack that is about to be reused: functions that were
    /// abandoned on it may have left marks around their variables.
    AddressNotes(void* bottom, std::size_t size) : bottom_(bottom), size_(size) {
        freeing(bottom, size);
    }
    /// Clear the marks of a stack that is about to be freed: a fiber ends inside the functions that
    /// it began in, whose marks would affect whatever is mapped there next, for example the errno
    /// of a new thread.
    static void freeing(void* bottom, std::size_t size) {
        ASAN_UNPOISON_MEMORY_REGION(bottom, size);
    }
    void entering() { __sanitizer_start_switch_fiber(&outer_fake_, bottom_, size_); }
    void entered() { __sanitizer_finish_switch_fiber(inner_fake_, &outer_bottom_, &outer_size_); }
    void leaving(bool for_good) {
        __sanitizer_start_switch_fiber(for_good ? nullptr : &inner_fake_, outer_bottom_,
                                       outer_size_);
    }
    void left() { __sanitizer_finish_switch_fiber(outer_fake_, nullptr, nullptr); }

  private:
    void* bottom_;
    std::size_t size_;
    void *outer_fake_ = nullptr, *inner_fake_ = nullptr;
    const void* outer_bottom_ = nullptr;
    std::size_t outer_size_ = 0;
};
using StackNotes = AddressNotes;

#elif defined(__SANITIZE_THREAD__)

/// ThreadSanitizer is told from outside the fiber, before it is entered and after it was left,
/// because it pairs the calls and returns of a fiber. For the same reason both functions are
/// inlined.
class ThreadNotes {
  public:
    ThreadNotes(void*, std::size_t) : inner_(__tsan_create_fiber(0)) {}
    ~ThreadNotes() { __tsan_destroy_fiber(inner_); }
    static void freeing(void*, std::size_t) {}
    ThreadNotes(const ThreadNotes&) = delete;
    ThreadNotes& operator=(const ThreadNotes&) = delete;
    [[gnu::always_inline]] void entering() {
        outer_ = __tsan_get_current_fiber();
        __tsan_switch_to_fiber(inner_, 0);
    }
    void entered() {}
    void leaving(bool) {}
    [[gnu::always_inline]] void left() { __tsan_switch_to_fiber(outer_, 0); }

  private:
    void* inner_;
    void* outer_ = nullptr;
};
using StackNotes = ThreadNotes;

#else

/// Calls, in the order in which a fiber is used: entering() before a switch to it, entered() first
/// thing on it; leaving() on it before it is suspended or ends, left() after that; freeing() when
/// it has ended, before its stack is unmapped.
class NoNotes {
  public:
    NoNotes(void*, std::size_t) {}
    static void freeing(void*, std::size_t) {}
    void entering() {}
    void entered() {}
    void leaving(bool) {}
    void left() {}
};
using StackNotes = NoNotes;

#endif

}  // namespace lightwalk
