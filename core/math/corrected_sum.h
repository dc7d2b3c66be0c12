#pragma once
// What a picture sums up to, and how well that is known where its pixels are not right.
#include <cstddef>
#include <span>

#include "core/math/function_ref.h"
#include "core/math/random.h"
#include "core/math/student_t.h"

namespace lightwalk {

/// A term of a sum: a factor that is exact, times a value that may be off.
struct KnownTerm {
    double weight = 0;
    double value = 0;
};

inline constexpr int kCorrectionRounds = 16, kCorrectionDraws = 8;

/// The sum of weight times true value. To that of the known values it adds what the truth differs
/// by, as samples of it tell at some of the terms, and the interval is that of these differences.
/// So whatever ails the known values (noise that neighbours share, light that is interpolated,
/// pixels that are guessed) is in the interval, and how they vary from term to term is not.
/// @param sample  of a term's true value: each call independent of the others and of what is known,
///                and right in the mean. It is called kCorrectionRounds * kCorrectionDraws times,
///                for terms of much weight and value more often
/// Source: the difference estimator, Särndal, Swensson & Wretman, "Model assisted survey sampling"
/// (1992), ch. 6.3, with probabilities of selection by size.
[[nodiscard]] MeanInterval corrected_sum(std::span<const KnownTerm> terms, RandomStream random,
                                         FunctionRef<double(std::size_t term)> sample);

}  // namespace lightwalk
