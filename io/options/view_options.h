#pragma once
// The options of a view, as rpict takes them from the command line.
#include <memory>
#include <vector>

#include "core/view/view.h"
#include "io/files/file_source.h"
#include "io/options/option_rows.h"

namespace lightwalk {

/// The rows of -vt -vp -vd -vu -vh -vv -vo -va -vs -vl, which set a view. It must outlive them.
[[nodiscard]] std::vector<OptionRow> view_option_rows(View& view,
                                                      const std::shared_ptr<FileSource>& files);

/// Take the view option that stands in option position, -vf too, with its arguments; false: it is
/// another option. Throws UsageError for wrong arguments, InputError for a file that holds no view.
bool take_view_option(OptionWords& words, View& view, FileSource& files);

}  // namespace lightwalk
