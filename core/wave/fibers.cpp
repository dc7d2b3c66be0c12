#include "core/wave/fibers.h"

#include <boost/context/fiber.hpp>
#include <boost/context/protected_fixedsize_stack.hpp>
#include <cassert>
#include <new>
#include <optional>
#include <utility>

#include "core/wave/stack_notes.h"

namespace lightwalk {

class Fibers::Fiber {
  public:
    Fiber()
        : stack_(allocator_.allocate()),
          notes_(bottom(), stack_.size),
          inside_(std::allocator_arg, boost::context::preallocated(stack_.sp, stack_.size, stack_),
                  allocator_, [this](boost::context::fiber&& caller) {
                      outside_ = std::move(caller);
                      notes_.entered();
                      while (work_) {
                          (*work_)();
                          work_.reset();
                          leave(false);
                      }
                      notes_.leaving(true);
                      return std::move(outside_);
                  }) {}
    ~Fiber() { go_on(); }  // without work it ends
    Fiber(const Fiber&) = delete;
    Fiber& operator=(const Fiber&) = delete;

    void set_work(FunctionRef<void()> work) { work_.emplace(work); }
    [[nodiscard]] bool is_idle() const { return !work_; }
    [[nodiscard]] std::size_t room() const {
        return static_cast<std::size_t>(static_cast<const char*>(__builtin_frame_address(0)) -
                                        bottom());
    }

    /// From outside: run until it leaves.
    void go_on() {
        notes_.entering();
        inside_ = std::move(inside_).resume();
        notes_.left();
    }
    /// From inside.
    void leave(bool for_good) {
        notes_.leaving(for_good);
        outside_ = std::move(outside_).resume();
        notes_.entered();
    }

  private:
    [[nodiscard]] char* bottom() const { return static_cast<char*>(stack_.sp) - stack_.size; }

    boost::context::protected_fixedsize_stack allocator_{kStackBytes};
    boost::context::stack_context stack_;  ///< freed with inside_
    StackNotes notes_;
    std::optional<FunctionRef<void()>> work_;
    boost::context::fiber outside_;
    boost::context::fiber inside_;
};

Fibers::Fibers(std::size_t count) : all_(count) {}
Fibers::~Fibers() = default;

bool Fibers::prepare(std::size_t i) {
    try {
        if (!all_[i]) all_[i] = std::make_unique<Fiber>();
        return true;
    } catch (const std::bad_alloc&) {
        return false;
    }
}

bool Fibers::start(std::size_t i, FunctionRef<void()> work) {
    assert(all_[i]->is_idle());
    all_[i]->set_work(work);
    return enter(i);
}

bool Fibers::resume(std::size_t i) {
    assert(!all_[i]->is_idle());
    return enter(i);
}

bool Fibers::enter(std::size_t i) {
    assert(running_ == nullptr);
    running_ = all_[i].get();
    running_->go_on();
    running_ = nullptr;
    return all_[i]->is_idle();
}

bool Fibers::has_room() const {
    return running_->room() > kStackBytes / 2;
}

void Fibers::wait() {
    running_->leave(false);
}

}  // namespace lightwalk
