#include "io/options/manual_page.h"

#include <doctest/doctest.h>

using namespace lightwalk;

TEST_CASE("manual pages: what roff would take for its own is printed as it was written") {
    double width = 2;
    bool shown = true;
    const OptionTable options({"show", 1},
                              {{{"Size", SectionTitle{}},
                                {"-w W", &width, ".width, \"a\\b\"\nof a picture-frame"},
                                {"Others", SectionTitle{}},
                                {"--secret", &shown, "for tests", {.hidden = true}},
                                {"-r", RefusedOption{": gone"}}}});
    const std::string page = manual_page(
        {"tool-show", "tool show", "SCENE...", "a picture",
         "One line,\nand one.\n\n  tool show -w 1\n  'quoted'\nmore\n", "  last\n", "tool(1)"},
        &options, "1.2");
    CHECK(page == R"(.TH "TOOL\-SHOW" 1 "" "Lightwalk 1.2" "User Commands"
.SH NAME
tool\-show \- a picture
.SH SYNOPSIS
\fBtool show\fR SCENE...
.SH DESCRIPTION
.PP
One line,
and one.
.PP
.RS 2
.nf
tool show \-w 1
\&'quoted'
.fi
.RE
more
.SH OPTIONS
.SS "Size"
.TP
\fB\-w\fR W
\&.width, "a\eb"
.br
of a picture\-frame (default 2)
.SH EXAMPLES
.PP
.RS 2
.nf
last
.fi
.RE
.SH SEE ALSO
tool(1)
)");
}
