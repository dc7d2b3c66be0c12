// Function files made to exhaust a reader: each ends with an answer or an error, soon.
#include <doctest/doctest.h>

#include <string>

#include "tests/core/function/evaluate.h"
#include "tests/tolerance.h"

namespace lightwalk::test {
namespace {

std::string repeat(const std::string& text, int n) {
    std::string all;
    for (int i = 0; i < n; ++i) all += text;
    return all;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A chain of definitions, for i from 1: `left`, i, then `right` with i - 1 for each '#'.
std::string chain(const std::string& left, const std::string& right, int n) {
    std::string all;
    for (int i = 1; i <= n; ++i) {
        all += left;
        all += std::to_string(i);
        for (const char c : right) {
            if (c == '#') {
                all += std::to_string(i - 1);
            } else {
                all += c;
            }
        }
    }
    return all;
}

constexpr int kMany = 100000;

}  // namespace

TEST_CASE("nesting without end is an error, not a stack overflow") {
    CHECK(contains(complaint(repeat("(", kMany) + "1"), "nests more than"));
    CHECK(contains(complaint(repeat("sin(", kMany) + "1"), "nests more than"));
    CHECK(contains(complaint("2" + repeat("^Px", kMany)), "nests more than"));
    CHECK(contains(complaint(repeat("if(1,", kMany) + "1"), "nests more than"));
    CHECK(contains(complaint("Px" + repeat("-Px", kMany)), "nest more than"));
    CHECK(contains(complaint("Px" + repeat("/Px", kMany)), "nest more than"));
    CHECK(contains(complaint("Px" + repeat("+Px-Px", kMany)), "nest more than"));
    CHECK(contains(complaint("1", repeat("{", kMany)), "comment does not end"));
}

TEST_CASE("long lists are no problem") {
    CHECK(value_of("1" + repeat("+1", kMany)) == kMany + 1);
    CHECK(value_of("o" + repeat("+o", kMany), "o = 1;") == kMany + 1);
    CHECK(value_of("t", "o = 1; t = o" + repeat("*o", kMany) + ";") == 1);
    CHECK(value_of("max(1" + repeat(",2", kMany) + ")") == 2);
    CHECK(value_of("select(o+2" + repeat(",Rdot*3", kMany) + ")", "o = 1;") == 3);
    CHECK(value_of(repeat("x", kMany), repeat("x", 127) + " = 4;") == 4);
}

TEST_CASE("recursion ends with an error when nothing else ends it") {
    CHECK(contains(complaint("f(1)", "f(x) = f(x);"), "function file: "));
    CHECK(contains(complaint("f(1)", "f(x) = f(x+1) + 1;"), "function file: "));
    CHECK(contains(complaint("f(Rdot)", "f(x) = if(x, f(x+1), 0) + 1;"), "recursion is too deep"));
    CHECK(contains(complaint("f(Rdot)", "f(x) = if(x, f(x)+f(x), 0);"), "recursion is too deep"));
    CHECK(contains(complaint("f(Rdot)", "f(x) = g(x)+1; g(x) = if(Rdot, f(x), 0);"),
                   "recursion is too deep"));
    CHECK(contains(complaint("f(g)", "f(x) = x(x); g(x) = f(x) + 1;"), "recursion is too deep"));
    CHECK(contains(complaint("1", "f(n) : f(n)+1;\nk = f(1);"), "tt.cal:2: function file: "));
}

TEST_CASE("work without end is an error") {
    const std::string fib = "fib(n) = if(n-1.5, fib(n-1)+fib(n-2), n);";
    CHECK(contains(complaint("fib(60.5)", fib), "takes too long"));
    CHECK(contains(complaint("fib(60.5*Rdot)", fib), "takes too long"));
    CHECK(contains(complaint("1", "fib(n) : if(n-1.5, fib(n-1)+fib(n-2), n);\n\nk = fib(60);"),
                   "tt.cal:3: "));
    CHECK(value_of("fib(20*Rdot)", fib) == 6765);
    CHECK(value_of("fib(60*Rdot)", fib) == 1548008755920);  // of integers they are known
}

TEST_CASE("deep recursion that ends has a value") {
    CHECK(value_of("f(5000*Rdot)", "f(n) = if(n-.5, 1+f(n-1), 0);") == 5000);
    CHECK(value_of("f(5000)", "f(n) = if(n-.5, 1+f(n-1), 0);") == 5000);
    // Arguments by need pile up just as deep.
    CHECK(value_of("f(5000*Rdot,0)", "f(n,s) = if(n-.5, f(n-1,s+1), s);") == 5000);
    CHECK(value_of("turbulence(.3,.4,.5,1e-300)") > 0);
}

TEST_CASE("inlining does not multiply the code without bound") {
    CHECK(contains(complaint("f60(Px)", "f0(x) = x+1;" + chain("f", "(x) = f#(x)+f#(x+1);", 60)),
                   "takes too long"));
    CHECK(value_of("f16(Px)", "f0(x) = x;" + chain("f", "(x) = f#(x)+f#(x+1);", 16)) ==
          16 * 32768.0);
    // Arguments used many times are computed once, however deep.
    CHECK(value_of("f200(Rdot)", "f0(x) = x;" + chain("f", "(x) = f#((x+x)/2);", 200)) == 1);
    // A variable is computed once an epoch.
    CHECK(value_of("v1000", "v0 = Rdot;" + chain("v", " = (v#+v#)/2;", 1000)) == 1);
}

TEST_CASE("chains of definitions may be as long as a file") {
    CHECK(value_of("v20000", "v0 = Rdot;" + chain("v", " = 1+v#;", 20000)) == 20001);
    CHECK(value_of("v20000", "v0 = sin(0);" + chain("v", " = sin(v#);", 20000)) == 0);
    CHECK(value_of("f3000(Rdot)", "f0(x) = x;" + chain("f", "(x) = 1+f#(x);", 3000)) == 3001);
    CHECK(value_of("f3000(Rdot)", "f0(x) = x;" + chain("f", "(x) = f#(x+1);", 3000)) == 3001);
    // Long arguments below long bodies.
    const std::string deep = repeat("(x-", 290) + "x" + repeat(")", 290);
    (void)value_of("f60(Rdot)", "f0(x) = x;" + chain("f", "(x) = f#(" + deep + ");", 60));
    (void)value_of("f60(Rdot)",
                   "f0(x) = " + deep + ";" + chain("f", "(x) = f#(" + deep + ")-x;", 60));
    // Constants that the whole chain stands behind.
    CHECK(value_of("k3000", "k0 : 1;" + chain("k", " : 1+k#;", 3000)) == 3001);
}

TEST_CASE("variables in a circle end") {
    CHECK(value_of("a", "a = a + 1;") == 1);
    CHECK(value_of("a", "a = b + 1; b = a + 1;") == 2);
    CHECK(value_of("a", "a = f(3); f(x) = a + x;") == 3);
    CHECK(value_of("a", "a = f(3*Rdot); f(x) = if(x-.5, f(x-1) + a, 1);") == 1);
    // So many that they are not seen to be one.
    const std::string circle = chain("v", " = 1+v#;", 5000) + "v0 = v5000;";
    CHECK(value_of("v5000", circle) == 5000);
}

TEST_CASE("functions that are called with ever different functions are too many") {
    std::string text = "f(a,b,c,n) = if(n, a(1), f(b,c,a,n-1)";
    for (int i = 0; i < 40; ++i) text += "+f(g" + std::to_string(i) + ",a,b,n)";
    text += ");";
    for (int i = 0; i < 40; ++i) text += "g" + std::to_string(i) + "(x) = x;";
    CHECK(contains(complaint("f(g1,g2,g3,Rdot)", text),
                   "scene.rad:7: expression too complicated: it needs more than"));
}

TEST_CASE("bytes that are no text are errors with their place") {
    std::string all;
    for (int c = 1; c < 256; ++c) all += static_cast<char>(c);
    CHECK(contains(complaint("1", all), "tt.cal:"));
    CHECK(contains(complaint("1", "a = 1;\nb = \xc3\xa4;"),
                   "tt.cal:2: syntax error: found byte 195"));
    CHECK(contains(complaint("1", std::string("a = 1;\0b = 2;", 13)),
                   "tt.cal:1: syntax error: found byte 0"));
    CHECK(contains(complaint("$99999999999999999999"), "illegal channel"));
    CHECK(value_of("1e99999999999999999999", "") > 1e308);
    CHECK(value_of("1e-99999999999999999999", "") == 0);
    CHECK(value_of(repeat("9", 400) + "e-400", "") == rounded(1));
    CHECK(value_of("." + repeat("0", 400) + "1e401", "") == rounded(1));
}

}  // namespace lightwalk::test
