#include "io/options/view_options.h"

#include "core/error.h"
#include "io/options/view_text.h"

namespace lightwalk {

std::vector<OptionRow> view_option_rows(View& v, const std::shared_ptr<FileSource>& files) {
    const auto take = [&v, files](OptionWords& words) {
        return take_view_option(words, v, *files);
    };
    std::vector<OptionRow> rows{
        {"View", SectionTitle{"render"}},
        {"-vtv|l|c|h|a|s", AttachedOption{"-vt", take, [&v] { return std::string(1, v.type); }},
         "view type | perspective, parallel, cylindrical, hemispherical, angular or stereographic "
         "view"},
        {"-vp X Y Z", &v.position, "view point [m] |"},
        {"-vd X Y Z", &v.direction, "view direction |"},
        {"-vu X Y Z", &v.up, "view up | direction that is up in the picture"},
        {"-vh H", &v.horizontal,
         "view horizontal size | horizontal size [degrees; of parallel views m]"},
        {"-vv V", &v.vertical, "view vertical size | vertical size [degrees; of parallel views m]"},
        {"-vo D", &v.fore, "view fore clipping [m] | nothing nearer than this is seen [m]"},
        {"-va D", &v.aft,
         "view aft clipping [m] | nothing farther than this is seen [m]; 0: no limit"},
        {"-vs S", &v.shift, "view shift | shift of the picture to the right, in its widths"},
        {"-vl L", &v.lift, "view lift | lift of the picture, in its heights"}};
    for (OptionRow& row : rows) row.with.take = take;
    return rows;
}

bool take_view_option(OptionWords& words, View& view, FileSource& files) {
    const std::vector<std::string> rest = words.rest();
    try {
        const std::size_t used = parse_view_option(rest, view, files);
        words.skip(used);
        return used > 0;
    } catch (const InputError& error) {
        if (rest.front() == "-vf" && rest.size() > 1)
            throw;  // the file is at fault, not the command line
        throw UsageError(error.what());
    }
}

}  // namespace lightwalk
