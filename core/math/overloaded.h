#pragma once
// What visits a variant.

namespace lightwalk {

/// Calls that one of several functions that takes what a variant holds; a kind that none takes does
/// not compile.
template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace lightwalk
