#pragma once
// Answers to separate rays that are made of the terms of their radiance.
#include <string>
#include <vector>

#include "core/ambient/coefficient_cache.h"
#include "core/transport/contribution.h"
#include "core/transport/trace_context.h"

namespace lightwalk {

/// Collects the terms of one ray after the other. Belongs to one thread.
class RayTally : public ContributionSink {
  public:
    /// Who has to be told of every ray as well; null: nobody.
    [[nodiscard]] virtual RayObserver* observer() { return nullptr; }
    /// Appends the answer to the ray whose terms were told since the last call.
    virtual void take(std::string& bytes) = 0;
    /// The same terms for a record of coefficients; columns are those of the answers.
    [[nodiscard]] virtual std::vector<CoefficientTerm> take_terms() = 0;
};

}  // namespace lightwalk
