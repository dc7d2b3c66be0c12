#pragma once
// How well the mean of a few independent answers is known.
#include <span>

namespace lightwalk {

/// What a variable of Student's distribution stays within, above and below 0, with a probability of
/// 95 %: its 97.5 % quantile, to 5 decimals.
/// @param degrees  of freedom, at least 1: one fewer than there are answers
/// Source: "Student" (W. S. Gosset), "The probable error of a mean", Biometrika 6 (1908), as Fisher
/// has tabulated it; beyond 30 degrees the expansion of Cornish & Fisher in Abramowitz & Stegun,
/// "Handbook of Mathematical Functions" (1964), 26.7.5.
[[nodiscard]] double student_t_95(int degrees);

/// A mean, and how far its 95 % confidence interval reaches to both sides.
struct MeanInterval {
    double mean = 0, half_width = 0;
};

/// The mean of independent answers to one question. Were each normal, 95 % of such intervals would
/// hold the mean of all possible answers. Few answers that are mostly 0 and rarely large are not:
/// while none of the large ones is among them the interval is too short.
/// @param answers  at least 2; one that is not finite makes the half-width so, too
[[nodiscard]] MeanInterval mean_interval(std::span<const double> answers);

/// Some of the answers to a question.
struct AnswerBatch {
    double mean = 0;
    int count = 0;
};

/// The same where only the means of batches of answers are kept: the batches' spread takes the
/// place of that of the answers. Batches without answers do not count.
/// @return  an infinite half-width where fewer than two batches have any
/// Source: the mean square between groups in an analysis of variance (Fisher 1925).
[[nodiscard]] MeanInterval mean_interval(std::span<const AnswerBatch> batches);

}  // namespace lightwalk
