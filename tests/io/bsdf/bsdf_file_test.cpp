#include "io/bsdf/bsdf_file.h"

#include <doctest/doctest.h>

#include <string>

#include "core/bsdf/bsdf.h"
#include "core/error.h"
#include "tests/io/bsdf/bsdf_text.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const BsdfMatrix& matrix_in(const BsdfData& data, BsdfPart part = BsdfPart::front_transmission) {
    REQUIRE(data.part(part));
    return std::get<BsdfMatrix>(*data.part(part));
}

std::string problem_of(const std::string& text) {
    try {
        (void)decode_bsdf(text, "a.xml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

/// One text replaced in another.
std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

const std::string kNine = "1, 2, 3,\n4 5 6\n-7,8,9,";

}  // namespace

TEST_CASE("BSDF files: in Columns incident patches run fastest, in Rows exitant ones") {
    const BsdfData columns = decode_bsdf(matrix_text(kNine), "a.xml"),
                   rows = decode_bsdf(matrix_text(kNine, "rows"), "a.xml");
    const std::vector<float> given{1, 2, 3, 4, 5, 6, 0, 8, 9};
    CHECK(matrix_in(rows).y == given);
    for (std::size_t o = 0; o < 3; ++o) {
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(matrix_in(columns).y[i * 3 + o] == given[o * 3 + i]);
    }
    CHECK(columns.name == "three");
    CHECK(columns.size[2] == doctest::Approx(0.02));
    CHECK(columns.size[0] == 0);
}

TEST_CASE("BSDF files: line ends of DOS, comments and words in other cases change nothing") {
    std::string dos;
    for (const char c : matrix_text(kNine))
        dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
    CHECK(matrix_in(decode_bsdf(dos, "a.xml")).y ==
          matrix_in(decode_bsdf(matrix_text(kNine), "a.xml")).y);
    const std::string comment = with(matrix_text(kNine), "4 5", "4 <!-- four -->\n5");
    CHECK(matrix_in(decode_bsdf(comment, "a.xml")).y.size() == 9);
    const std::string words = with(matrix_text(kNine), "Transmission Back", " transmission back ");
    CHECK(decode_bsdf(words, "a.xml").part(BsdfPart::front_transmission));
}

TEST_CASE("BSDF files: other wavelengths are skipped, and colours need both X and Z") {
    CHECK(
        problem_of(with(matrix_text(kNine), "Visible", "Solar")).find("a.xml:3: no visible data") ==
        0);
    const auto block = [](const std::string& wavelength) {
        return "<WavelengthData><Wavelength>" + wavelength +
               "</Wavelength><WavelengthDataBlock><WavelengthDataDirection>Transmission Back"
               "</WavelengthDataDirection><ColumnAngleBasis>Own</ColumnAngleBasis>"
               "<RowAngleBasis>Own</RowAngleBasis><ScatteringData>2 2 2 2 2 2 2 2 "
               "2</ScatteringData>"
               "</WavelengthDataBlock></WavelengthData>\n";
    };
    const std::string ones = "1 1 1 1 1 1 1 1 1";
    CHECK(matrix_in(decode_bsdf(matrix_text(ones, "Columns", block("CIE-X")), "a")).xz.empty());
    const BsdfData both =
        decode_bsdf(matrix_text(ones, "Columns", block("CIE-X") + block("CIE-Z")), "a");
    REQUIRE(matrix_in(both).xz.size() == 9);
    CHECK(matrix_in(both).xz[4][1] == 2);
    const BsdfData later = decode_bsdf(matrix_text(ones, "Columns", block("Visible")), "a");
    CHECK(matrix_in(later).y[0] == 2);
}

TEST_CASE("BSDF files: 73 values a side are the half basis of older files") {
    const auto half = [](std::size_t side) {
        std::string values;
        for (std::size_t i = 0; i < side * side; ++i) values += "0.1 ";
        std::string text = matrix_text(values);
        for (const std::string name : {"<ColumnAngleBasis>", "<RowAngleBasis>"})
            text = with(text, name + "Own", name + "LBNL/Klems Half");
        return text;
    };
    const std::string older = half(73), newer = half(77);
    CHECK(matrix_in(decode_bsdf(older, "a")).incident.size() == 73);
    CHECK(matrix_in(decode_bsdf(newer, "a")).exitant.size() == 77);
}

TEST_CASE("BSDF files: tensor trees of nodes, grids and lone values") {
    const BsdfData lone = decode_bsdf(tree_text("{0.25}"), "a");
    CHECK(std::get<BsdfTree>(*lone.part(BsdfPart::front_reflection)).y.nodes().empty());
    const BsdfData grid = decode_bsdf(tree_text("{1,2,3,4 5 6 7 8}"), "a");
    CHECK(std::get<BsdfTree>(*grid.part(BsdfPart::front_reflection)).y.sound());
    const BsdfData nodes =
        decode_bsdf(tree_text("{ {1}{2}{3}{4}{5}{6}{7} {1 2 3 4 5 6 7 8} }"), "a");
    const auto& tree = std::get<BsdfTree>(*nodes.part(BsdfPart::front_reflection)).y;
    CHECK(tree.sound());
    CHECK(tree.nodes().size() == 16);
    CHECK(Bsdf(std::make_shared<BsdfData>(nodes)).reflection(true).lobes);
}

TEST_CASE("BSDF files: damaged ones are refused with the line and what is wrong") {
    const std::string sound = matrix_text(kNine);
    CHECK(problem_of("") != "none");
    CHECK(problem_of("<a><b></a>").find("a.xml:1: bad XML: ") == 0);
    CHECK(problem_of("\n<a/>").find("a.xml:2: the root of a BSDF file is not WindowElement") == 0);
    CHECK(problem_of(with(sound, ">BSDF<", ">IES<")).find("a.xml:3: FileType is not BSDF") == 0);
    CHECK(problem_of(with(sound, "4 5 6", "4 five 6"))
              .find("a.xml:15: found \"five\", expected a number") == 0);
    CHECK(problem_of(with(sound, "4 5 6", "4 nan 6")).find("a.xml:15: ") == 0);
    CHECK(problem_of(with(sound, "4 5 6", "4 1e300 6"))
              .find("a.xml:15: the number 1e300 is out of range") == 0);
    CHECK(problem_of(with(sound, "4 5 6", "4 5")).find("too few values: 8, expected 9") !=
          std::string::npos);
    CHECK(problem_of(with(sound, "Columns", "Diagonals"))
              .find("a.xml:5: unknown IncidentDataStructure") == 0);
    CHECK(problem_of(with(sound, "Centimeter", "Furlong"))
              .find("a.xml:4: unknown unit \"Furlong\"") == 0);
    CHECK(problem_of(with(sound, "<RowAngleBasis>Own", "<RowAngleBasis>Their"))
              .find("a.xml:12: undefined angle basis \"Their\"") == 0);
    CHECK(problem_of(with(sound, "<LowerTheta>30", "<LowerTheta>31"))
              .find("a.xml:8: LowerTheta is not the UpperTheta of the ring before") == 0);
    CHECK(problem_of(with(sound, "<UpperTheta>90", "<UpperTheta>80"))
              .find("a.xml:6: the rings of an AngleBasis do not reach 90 degrees") == 0);
    CHECK(problem_of(with(sound, "<nPhis>2", "<nPhis>1")).find("a.xml:8: bad nPhis") == 0);
    CHECK(problem_of(with(sound, "Transmission Back", "Sideways")).find("no visible data") !=
          std::string::npos);
    CHECK(problem_of(sound) == "none");
}

TEST_CASE("BSDF files: damaged trees are refused with the line") {
    CHECK(problem_of(tree_text("{1 2 3}"))
              .find("a.xml:7: a node of the tensor tree has 3 values, expected a power of 8") == 0);
    CHECK(problem_of(tree_text("{1} 2")).find("a.xml:7: something follows") == 0);
    CHECK(problem_of(tree_text("{ {1} {2}\n}"))
              .find("a.xml:8: a node of the tensor tree has not 8 nodes") == 0);
    CHECK(problem_of(tree_text("{}")).find("a.xml:7: a node of the tensor tree is empty") == 0);
    CHECK(problem_of(tree_text("{1")).find("a.xml:7: expected }") == 0);
    CHECK(problem_of(tree_text("1")).find("a.xml:7: expected {") == 0);
    CHECK(problem_of(tree_text(std::string(1000, '{'))).find("deeper than 20 levels") !=
          std::string::npos);
    CHECK(problem_of(tree_text("{1}", 3, "Sunlight")).find("no visible data") != std::string::npos);
    CHECK(problem_of(with(tree_text("{1}"), "Shirley-Chiu", "Klems Full"))
              .find("not LBNL/Shirley-Chiu") != std::string::npos);
}
