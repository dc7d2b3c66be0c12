#pragma once
// Tells the sanitizers when a fiber's stack takes over: without it they would take what lies on it
// for errors. Nothing in other builds.
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
    /// What stood at these addresses before may have been left in the middle of functions: marks
    /// around their variables would be taken for those of the new ones.
    AddressNotes(void* bottom, std::size_t size) : bottom_(bottom), size_(size) {
        freeing(bottom, size);
    }
    /// A fiber is left in the middle of the functions that it began in. Their marks would stay for
    /// what is mapped there next, and a thread that finds its errno there does not clear them.
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

/// All is told from outside, where the fiber is entered and after it was left: what runs in between
/// belongs to the fiber, and calls and returns are counted in pairs. Hence inlined, both.
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

/// Calls in the order in which a fiber is used: entering() before it takes over, entered() on it;
/// leaving() on it before it gives up, for good or not, left() after that; freeing() once it was
/// left for good, before its addresses are given back.
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
