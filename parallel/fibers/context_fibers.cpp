#include "parallel/fibers/context_fibers.h"

#include <boost/context/fiber.hpp>
#include <boost/context/protected_fixedsize_stack.hpp>
#include <cassert>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "parallel/fibers/stack_notes.h"

namespace lightwalk {
namespace {

/// Offsets of the beginnings of stacks within a page (cache colouring). Without them data at the
/// same depth of all stacks would map to the same cache sets and evict each other.
constexpr std::size_t kShift = 192, kShifts = 21;  ///< [bytes], and how many: within a page

/// A stack allocator: Boost.Context's with a guard page, and a notice to sanitizers before a stack
/// is freed. It is copied into the fiber, which frees its stack itself.
class Stacks {
  public:
    [[nodiscard]] boost::context::stack_context allocate() { return guarded_.allocate(); }
    void deallocate(boost::context::stack_context& stack) {
        StackNotes::freeing(static_cast<char*>(stack.sp) - stack.size, stack.size);
        guarded_.deallocate(stack);
    }

  private:
    boost::context::protected_fixedsize_stack guarded_{kFiberStackBytes};
};

class Fiber {
  public:
    /// @param shift  where it begins below the stack's top [bytes]
    explicit Fiber(std::size_t shift)
        : stack_(allocator_.allocate()),
          notes_(bottom(), stack_.size),
          inside_(std::allocator_arg,
                  boost::context::preallocated(static_cast<char*>(stack_.sp) - shift,
                                               stack_.size - shift, stack_),
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

    /// Called outside the fiber: run it until it leaves.
    void go_on() {
        notes_.entering();
        inside_ = std::move(inside_).resume();
        notes_.left();
    }
    /// Called inside the fiber: return to go_on().
    void leave(bool for_good) {
        notes_.leaving(for_good);
        outside_ = std::move(outside_).resume();
        notes_.entered();
    }

  private:
    [[nodiscard]] char* bottom() const { return static_cast<char*>(stack_.sp) - stack_.size; }

    Stacks allocator_;
    boost::context::stack_context stack_;  ///< freed with inside_
    StackNotes notes_;
    std::optional<FunctionRef<void()>> work_;
    boost::context::fiber outside_;
    boost::context::fiber inside_;
};

class ContextFibers final : public Fibers {
  public:
    explicit ContextFibers(std::size_t count) : all_(count) {}

    [[nodiscard]] std::size_t size() const override { return all_.size(); }
    [[nodiscard]] bool prepare(std::size_t i) override {
        try {
            if (!all_[i]) all_[i] = std::make_unique<Fiber>(i % kShifts * kShift);
            return true;
        } catch (const std::bad_alloc&) {
            return false;
        }
    }
    bool start(std::size_t i, FunctionRef<void()> work) override {
        assert(all_[i]->is_idle());
        all_[i]->set_work(work);
        return enter(i);
    }
    bool resume(std::size_t i) override {
        assert(!all_[i]->is_idle());
        return enter(i);
    }
    void wait() override { running_->leave(false); }
    [[nodiscard]] bool has_room() const override { return running_->room() > kFiberStackBytes / 2; }

  private:
    bool enter(std::size_t i) {
        assert(running_ == nullptr);
        running_ = all_[i].get();
        running_->go_on();
        running_ = nullptr;
        return all_[i]->is_idle();
    }

    std::vector<std::unique_ptr<Fiber>> all_;
    Fiber* running_ = nullptr;
};

}  // namespace

std::unique_ptr<Fibers> make_context_fibers(std::size_t count) {
    return std::make_unique<ContextFibers>(count);
}

}  // namespace lightwalk
