#include "core/math/student_t.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

namespace lightwalk {
namespace {

constexpr std::array kTable{12.706205, 4.302653, 3.182446, 2.776445, 2.570582, 2.446912,
                            2.364624,  2.306004, 2.262157, 2.228139, 2.200985, 2.178813,
                            2.160369,  2.144787, 2.131450, 2.119905, 2.109816, 2.100922,
                            2.093024,  2.085963, 2.079614, 2.073873, 2.068658, 2.063899,
                            2.059539,  2.055529, 2.051831, 2.048407, 2.045230, 2.042272};

}  // namespace

double student_t_95(int degrees) {
    assert(degrees >= 1);
    const auto row = static_cast<std::size_t>(degrees - 1);
    if (row < kTable.size()) return kTable[row];
    constexpr double z = 1.959963984540054;  // the normal distribution's
    constexpr double z2 = z * z;
    const double n = degrees;
    return z + z * (z2 + 1) / 4 / n + z * ((5 * z2 + 16) * z2 + 3) / 96 / (n * n) +
           z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384 / (n * n * n);
}

MeanInterval mean_interval(std::span<const double> answers) {
    assert(answers.size() >= 2);
    const auto n = static_cast<double>(answers.size());
    // From the first answer on: what answers have in common would eat the digits of the rest.
    double sum = 0, squares = 0;
    for (const double x : answers) sum += x - answers.front();
    const double mean = sum / n;
    for (const double x : answers) {
        const double off = x - answers.front() - mean;
        squares += off * off;
    }
    const double error = std::sqrt(squares / (n - 1) / n);
    return {answers.front() + mean, student_t_95(static_cast<int>(answers.size()) - 1) * error};
}

MeanInterval mean_interval(std::span<const AnswerBatch> batches) {
    int answers = 0, used = 0;
    double first = 0, sum = 0, squares = 0;
    for (const AnswerBatch& batch : batches) {
        if (batch.count == 0) continue;
        if (used++ == 0) first = batch.mean;
        sum += batch.count * (batch.mean - first);
        answers += batch.count;
    }
    const double mean = answers > 0 ? sum / answers : 0;
    if (used < 2) return {first + mean, std::numeric_limits<double>::infinity()};
    for (const AnswerBatch& batch : batches) {
        const double off = batch.mean - first - mean;
        squares += batch.count * off * off;
    }
    return {first + mean, student_t_95(used - 1) * std::sqrt(squares / (used - 1) / answers)};
}

}  // namespace lightwalk
