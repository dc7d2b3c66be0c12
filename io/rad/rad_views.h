#pragma once
// The views of a rad file, and the standard views from the sides of its zone.
#include <string>
#include <vector>

#include "io/rad/rad_plan.h"

namespace lightwalk {

/// A view from the words of "view= [NAME] OPTIONS". Throws InputError for a name without options
/// that is none of the standard ones: [Xx][Yy][Zz], of these one at least, then a view type.
[[nodiscard]] RadView rad_view(const std::vector<std::string>& words, const SourceLocation& where);

/// The view that `name` means, a number from 1, a name, or a standard view. Throws InputError with
/// the views that there are.
[[nodiscard]] RadView find_rad_view(const RadPlan& plan, const std::string& name);

/// rpict's options for a view.
/// @param zone  that a standard view is of
[[nodiscard]] std::vector<std::string> rad_view_words(const RadPlan& plan, const RadView& view,
                                                      const RadZone& zone);

}  // namespace lightwalk
