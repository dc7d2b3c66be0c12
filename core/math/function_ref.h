#pragma once
// A non-owning reference to a callable, for callbacks on the hot path.
#include <type_traits>
#include <utility>

namespace lightwalk {

template <class Signature>
class FunctionRef;

/// Refers to a callable that must outlive the call it is passed to.
template <class R, class... Args>
class FunctionRef<R(Args...)> {
  public:
    template <class F, class = std::enable_if_t<!std::is_same_v<std::decay_t<F>, FunctionRef>>>
    // NOLINTNEXTLINE(google-explicit-constructor): call sites pass lambdas
    FunctionRef(F&& f)
        : object_(const_cast<void*>(static_cast<const void*>(&f))),
          call_([](void* object, Args... args) -> R {
              return (*static_cast<std::remove_reference_t<F>*>(object))(
                  std::forward<Args>(args)...);
          }) {}
    R operator()(Args... args) const { return call_(object_, std::forward<Args>(args)...); }

  private:
    void* object_;
    R (*call_)(void*, Args...);
};

}  // namespace lightwalk
