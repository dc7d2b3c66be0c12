#include "parallel/time_estimate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

using namespace lightwalk;

namespace {

struct Report {
    std::size_t phase;
    double seconds, done;
    std::uint64_t rays, values;
};

struct Recording {
    std::string name;
    int width, height, spacing;
    CachePrepass prepass;
    std::vector<Report> reports;
};

/// Pictures of two furnished rooms, as two threads made them, thinned out. The
/// machine had other work to do, too.
const std::vector<Recording> kRecordings{
    {"living room, one bounce, a coarse cache",
     256,
     192,
     4,
     CachePrepass::quick,
     {{0, 0.026, 0.04801, 21671, 23},   {0, 0.0288, 0.06602, 25123, 26},
      {0, 0.0401, 0.114, 38692, 39},    {0, 0.059, 0.162, 61671, 60},
      {0, 0.0748, 0.2041, 80104, 78},   {0, 0.0931, 0.2521, 100827, 98},
      {0, 0.1026, 0.3001, 111417, 108}, {0, 0.1042, 0.3158, 113694, 110},
      {0, 0.1205, 0.3638, 123071, 118}, {0, 0.1741, 0.4119, 138892, 137},
      {0, 0.1875, 0.4599, 165203, 162}, {0, 0.2047, 0.5079, 174961, 171},
      {0, 0.2185, 0.5259, 181882, 177}, {0, 0.2384, 0.5679, 191061, 185},
      {0, 0.2385, 0.6099, 216746, 213}, {0, 0.2633, 0.6579, 227286, 223},
      {0, 0.28, 0.7059, 253364, 249},   {0, 0.2887, 0.7479, 260308, 255},
      {0, 0.2945, 0.7659, 262898, 257}, {0, 0.3007, 0.814, 279444, 274},
      {0, 0.3104, 0.862, 292398, 286},  {0, 0.335, 0.91, 308368, 301},
      {0, 0.3573, 0.958, 318410, 310},  {0, 0.3621, 1, 340015, 337},
      {1, 0.4259, 0.06522, 53850, 12},  {1, 0.4948, 0.1087, 106684, 26},
      {1, 0.6079, 0.1522, 183924, 111}, {1, 0.6751, 0.212, 289075, 187},
      {1, 0.7565, 0.2935, 358051, 189}, {1, 0.8198, 0.375, 445155, 221},
      {1, 0.8828, 0.462, 524704, 230},  {1, 0.9538, 0.5435, 589755, 234},
      {1, 1.029, 0.6087, 678771, 305},  {1, 1.108, 0.7065, 787171, 366},
      {1, 1.199, 0.788, 856252, 370},   {1, 1.266, 0.8315, 892992, 382},
      {1, 1.342, 0.913, 976008, 397},   {1, 1.487, 1, 1090616, 459}}},
    {"living room, two bounces",
     192,
     144,
     4,
     CachePrepass::quick,
     {{0, 0.1453, 0.08696, 107245, 304}, {0, 0.1993, 0.1739, 130993, 364},
      {0, 0.254, 0.2609, 162752, 440},   {0, 0.3085, 0.337, 191508, 519},
      {0, 0.3182, 0.4239, 205268, 554},  {0, 0.3276, 0.5, 213321, 573},
      {0, 0.3916, 0.587, 231791, 626},   {0, 0.4095, 0.6739, 253478, 675},
      {0, 0.4201, 0.75, 260888, 693},    {0, 0.4362, 0.837, 272648, 717},
      {0, 0.4568, 0.913, 285858, 748},   {0, 0.5063, 1, 307543, 808},
      {1, 0.5808, 0.03865, 22649, 21},   {1, 0.6996, 0.0773, 73079, 126},
      {1, 0.7806, 0.1546, 134874, 193},  {1, 0.8846, 0.256, 207638, 284},
      {1, 0.9604, 0.3454, 255471, 323},  {1, 1.029, 0.4734, 312830, 331},
      {1, 1.131, 0.5507, 352754, 338},   {1, 1.214, 0.7053, 431818, 394},
      {1, 1.282, 0.756, 455885, 396},    {1, 1.363, 0.7947, 476442, 414},
      {1, 1.464, 0.8841, 532661, 498},   {1, 1.531, 0.9614, 577589, 520},
      {1, 1.56, 1, 596981, 521}}},
    {"living room, one bounce, every pixel traced",
     192,
     144,
     1,
     CachePrepass::quick,
     {{0, 0.1736, 0.08696, 117017, 58},  {0, 0.4575, 0.1739, 234382, 113},
      {0, 0.574, 0.2609, 376671, 176},   {0, 0.8898, 0.337, 498983, 236},
      {0, 1.051, 0.4239, 628348, 299},   {0, 1.137, 0.5, 728641, 347},
      {0, 1.348, 0.587, 827650, 401},    {0, 1.585, 0.6739, 953824, 461},
      {0, 1.602, 0.75, 1054477, 508},    {0, 1.924, 0.837, 1185902, 570},
      {0, 1.932, 0.913, 1299060, 629},   {0, 2.174, 1, 1430380, 691},
      {1, 2.587, 0.06763, 186940, 81},   {1, 2.933, 0.122, 459898, 203},
      {1, 3.252, 0.2053, 696187, 298},   {1, 3.59, 0.25, 975363, 419},
      {1, 3.919, 0.3237, 1243421, 541},  {1, 4.262, 0.378, 1483846, 724},
      {1, 4.621, 0.4517, 1743345, 832},  {1, 4.978, 0.5, 1953161, 966},
      {1, 5.306, 0.5543, 2142084, 1052}, {1, 5.661, 0.628, 2410657, 1183},
      {1, 6.002, 0.7017, 2696418, 1336}, {1, 6.337, 0.721, 2848142, 1405},
      {1, 6.754, 0.814, 3177855, 1558},  {1, 7.117, 0.907, 3472536, 1688},
      {1, 7.625, 1, 3832297, 1841}}},
    {"living room, deterministic",
     192,
     144,
     4,
     CachePrepass::deterministic,
     {{0, 1.673e-06, 0.008895, 128, 0},  {0, 0.4479, 0.02104, 74641, 17},
      {0, 1.747, 0.0668, 406228, 81},    {0, 2.306, 0.08895, 552198, 109},
      {0, 2.307, 0.1015, 552693, 109},   {0, 3.235, 0.1236, 877929, 173},
      {0, 3.98, 0.1488, 1213891, 237},   {0, 4.547, 0.1716, 1546303, 301},
      {0, 5.205, 0.1985, 1931250, 376},  {0, 5.549, 0.2147, 2165436, 422},
      {0, 5.552, 0.2325, 2167399, 422},  {0, 6.647, 0.2581, 2683313, 527},
      {0, 7.722, 0.2994, 3352923, 658},  {0, 8.624, 0.3497, 4161865, 822},
      {0, 9.61, 0.3917, 4905666, 974},   {0, 9.63, 0.3926, 4911042, 975},
      {0, 9.654, 0.4178, 4918523, 975},  {0, 11.41, 0.4745, 6091336, 1218},
      {0, 13.51, 0.6071, 7566436, 1522}, {0, 13.77, 0.6437, 7731770, 1558},
      {0, 13.77, 0.6442, 7731770, 1558}, {0, 13.89, 0.6798, 7762032, 1558},
      {0, 16.54, 0.805, 9476243, 1947},  {0, 17.31, 0.9909, 10033340, 2072},
      {0, 17.32, 1, 10043389, 2074},     {1, 17.45, 0.1546, 58393, 3},
      {1, 17.45, 0.3092, 116851, 3},     {1, 17.45, 0.3333, 118418, 3},
      {1, 17.61, 0.4879, 198201, 5},     {1, 17.62, 0.6425, 273209, 6},
      {1, 17.62, 0.6667, 279402, 6},     {1, 17.63, 0.6908, 286997, 6},
      {1, 17.7, 0.8454, 324728, 6},      {1, 17.74, 1, 377581, 8}}},
    {"living room, direct light",
     640,
     480,
     4,
     CachePrepass::none,
     {{0, 0.0247, 0.01394, 30267, 0},  {0, 0.164, 0.05577, 222967, 0},
      {0, 0.3244, 0.0976, 404921, 0},  {0, 0.4619, 0.1418, 624451, 0},
      {0, 0.5933, 0.2, 826633, 0},     {0, 0.7265, 0.2418, 972151, 0},
      {0, 0.8548, 0.2837, 1223016, 0}, {0, 0.9848, 0.3255, 1420171, 0},
      {0, 1.108, 0.3558, 1519293, 0},  {0, 1.23, 0.4139, 1776831, 0},
      {0, 1.431, 0.4558, 1952093, 0},  {0, 1.622, 0.5279, 2235712, 0},
      {0, 1.756, 0.5721, 2434902, 0},  {0, 1.882, 0.6279, 2597680, 0},
      {0, 2.07, 0.6837, 2834405, 0},   {0, 2.191, 0.7279, 3000774, 0},
      {0, 2.311, 0.8, 3258487, 0},     {0, 2.434, 0.8558, 3449320, 0},
      {0, 2.607, 0.9139, 3705112, 0},  {0, 2.756, 0.9582, 3881198, 0},
      {0, 2.835, 1, 4012035, 0}}},
    {"virtual room, direct light",
     640,
     480,
     4,
     CachePrepass::none,
     {{0, 0.0097, 0.01394, 648, 0},
      {0, 0.0286, 0.05577, 16828, 0},
      {0, 0.0543, 0.1115, 34198, 0},
      {0, 0.0894, 0.1697, 54296, 0},
      {0, 0.1099, 0.2139, 68824, 0},
      {0, 0.1339, 0.2837, 83640, 0},
      {0, 0.153, 0.3255, 102390, 0},
      {0, 0.191, 0.3697, 113648, 0},
      {0, 0.2103, 0.4279, 135769, 0},
      {0, 0.2296, 0.4976, 150945, 0},
      {0, 0.2564, 0.5721, 181259, 0},
      {0, 0.2863, 0.6558, 203505, 0},
      {0, 0.31, 0.6976, 218788, 0},
      {0, 0.3271, 0.7558, 235823, 0},
      {0, 0.3473, 0.8, 247022, 0},
      {0, 0.3678, 0.8861, 268704, 0},
      {0, 0.3913, 0.9279, 292300, 0},
      {0, 0.4094, 1, 305944, 0}}},
    {"living room, one bounce, the default cache",
     400,
     300,
     4,
     CachePrepass::quick,
     {{0, 0.0941, 0.0199, 80149, 17},    {0, 0.1317, 0.02736, 96313, 20},
      {0, 0.2455, 0.04726, 163493, 33},  {0, 0.3677, 0.06716, 210189, 42},
      {0, 0.4288, 0.08707, 262534, 54},  {0, 0.6352, 0.107, 333558, 67},
      {0, 0.6858, 0.1269, 450317, 87},   {0, 0.8861, 0.1468, 515139, 100},
      {0, 0.9267, 0.1667, 606795, 118},  {0, 0.9574, 0.1741, 617811, 120},
      {0, 0.9662, 0.194, 645479, 125},   {0, 1.061, 0.2139, 677257, 131},
      {0, 1.125, 0.2338, 745006, 143},   {0, 1.266, 0.2537, 809877, 160},
      {0, 1.341, 0.2736, 903321, 178},   {0, 1.536, 0.2935, 975726, 192},
      {0, 1.546, 0.3134, 1080616, 211},  {0, 1.67, 0.3333, 1128857, 220},
      {0, 1.711, 0.3408, 1145465, 223},  {0, 1.76, 0.3607, 1239839, 243},
      {0, 1.801, 0.3806, 1284125, 251},  {0, 1.812, 0.4005, 1306027, 255},
      {0, 2.053, 0.4204, 1391881, 270},  {0, 2.148, 0.4403, 1503682, 299},
      {0, 2.42, 0.4602, 1597961, 317},   {0, 2.443, 0.4801, 1706403, 338},
      {0, 2.477, 0.5, 1723981, 341},     {0, 2.538, 0.5075, 1747956, 345},
      {0, 2.584, 0.5274, 1790046, 353},  {0, 2.619, 0.5473, 1818235, 358},
      {0, 2.687, 0.5672, 1851868, 364},  {0, 2.78, 0.5871, 1905854, 374},
      {0, 2.85, 0.607, 1970862, 386},    {0, 3.081, 0.6269, 2049877, 402},
      {0, 3.225, 0.6468, 2103178, 412},  {0, 3.287, 0.6667, 2124236, 416},
      {0, 3.31, 0.6741, 2135546, 418},   {0, 3.311, 0.694, 2279535, 449},
      {0, 3.4, 0.7139, 2314322, 455},    {0, 3.565, 0.7338, 2382360, 469},
      {0, 3.765, 0.7537, 2484069, 499},  {0, 4.014, 0.7736, 2572883, 529},
      {0, 4.047, 0.7935, 2677176, 548},  {0, 4.129, 0.8134, 2724961, 560},
      {0, 4.178, 0.8333, 2747186, 564},  {0, 4.188, 0.8532, 2796988, 574},
      {0, 4.218, 0.8607, 2808293, 576},  {0, 4.255, 0.8806, 2842372, 582},
      {0, 4.297, 0.9005, 2876088, 588},  {0, 4.303, 0.9204, 2892291, 591},
      {0, 4.504, 0.9403, 2968725, 606},  {0, 4.84, 0.9602, 3094181, 633},
      {0, 4.854, 0.9801, 3216226, 674},  {0, 4.896, 1, 3247899, 680},
      {1, 6.849, 0.07568, 401207, 115},  {1, 9.973, 0.1024, 1033035, 313},
      {1, 12.22, 0.1468, 1409535, 450},  {1, 13.15, 0.2845, 2933274, 1015},
      {1, 14.03, 0.5468, 3718052, 1174}, {1, 14.97, 0.7954, 4443669, 1283},
      {1, 16.29, 0.8799, 5133260, 1419}, {1, 20.01, 0.9643, 6008067, 1706},
      {1, 21.24, 1, 6985889, 2061}}},
    {"virtual room, two bounces",
     240,
     180,
     4,
     CachePrepass::quick,
     {{0, 0.0716, 0.05517, 52278, 341},  {0, 0.1193, 0.1103, 88461, 604},
      {0, 0.2193, 0.1655, 138527, 929},  {0, 0.2544, 0.2, 155935, 1020},
      {0, 0.2993, 0.2552, 164645, 1064}, {0, 0.3034, 0.3103, 183654, 1155},
      {0, 0.3231, 0.3448, 190288, 1184}, {0, 0.3727, 0.4, 206748, 1253},
      {0, 0.3858, 0.4345, 212047, 1276}, {0, 0.4064, 0.4897, 216163, 1299},
      {0, 0.4107, 0.5448, 244449, 1423}, {0, 0.4345, 0.6, 252076, 1463},
      {0, 0.442, 0.6345, 257794, 1489},  {0, 0.5187, 0.6897, 269263, 1548},
      {0, 0.5442, 0.7448, 287026, 1626}, {0, 0.5538, 0.7793, 290582, 1642},
      {0, 0.582, 0.8345, 299917, 1691},  {0, 0.5839, 0.8897, 302146, 1706},
      {0, 0.6056, 0.9448, 311638, 1758}, {0, 0.6408, 1, 330241, 1850},
      {1, 0.7329, 0.06202, 27264, 110},  {1, 0.8251, 0.08682, 45919, 186},
      {1, 0.9397, 0.1953, 119172, 480},  {1, 1.033, 0.2574, 158092, 625},
      {1, 1.105, 0.3163, 182163, 708},   {1, 1.176, 0.4248, 218037, 820},
      {1, 1.26, 0.5705, 261980, 916},    {1, 1.334, 0.738, 299944, 981},
      {1, 1.402, 0.8217, 325730, 1045},  {1, 1.48, 0.9008, 354682, 1111},
      {1, 1.562, 0.9752, 386598, 1222},  {1, 1.629, 1, 403267, 1286}}},
};

TimeEstimator estimator_for(const Recording& recording) {
    FrameOptions options;
    options.width = recording.width;
    options.height = recording.height;
    options.pixels.spacing = recording.spacing;
    return TimeEstimator(plan_picture(options, recording.prepass, 2));
}

void add(TimeEstimator& estimator, const Report& report, double scale = 1) {
    estimator.add(report.phase, scale * report.seconds, {report.done, report.rays, report.values});
}

WorkPhase picture(double pixels) {
    return {WorkPhase::Kind::picture, pixels, 1, 1};
}

}  // namespace

TEST_CASE("after a tenth of the time its whole is known within a factor of two") {
    for (const Recording& recording : kRecordings) {
        CAPTURE(recording.name);
        TimeEstimator estimator = estimator_for(recording);
        const double whole = recording.reports.back().seconds;
        for (const Report& report : recording.reports) {
            add(estimator, report);
            if (report.seconds < 0.1 * whole) continue;
            CAPTURE(report.seconds);
            REQUIRE(estimator.estimate().seconds_left);
            const double predicted = report.seconds + *estimator.estimate().seconds_left;
            CAPTURE(predicted / whole);
            CHECK(predicted < 2 * whole);
            CHECK(predicted > whole / 2);
        }
        CHECK(*estimator.estimate().seconds_left < 0.1 * whole);
    }
}

TEST_CASE("the share done never falls, and stays between none and all") {
    for (const Recording& recording : kRecordings) {
        CAPTURE(recording.name);
        TimeEstimator estimator = estimator_for(recording);
        double last = 0;
        for (const Report& report : recording.reports) {
            add(estimator, report);
            CHECK(estimator.estimate().done >= last);
            last = estimator.estimate().done;
        }
        CHECK(last > 0.9);
        CHECK(last <= 1);
    }
}

TEST_CASE("estimates scale with time: the model holds no seconds") {
    const Recording& recording = kRecordings.front();
    TimeEstimator once = estimator_for(recording), slower = estimator_for(recording);
    for (const Report& report : recording.reports) {
        add(once, report);
        add(slower, report, 1000);
        CHECK(*slower.estimate().seconds_left ==
              doctest::Approx(1000 * *once.estimate().seconds_left).epsilon(1e-6));
    }
}

TEST_CASE("work at a constant rate is predicted exactly, and nothing before it began") {
    TimeEstimator estimator({picture(1e6)});
    CHECK_FALSE(estimator.estimate().seconds_left);
    CHECK(estimator.estimate().done == 0);
    for (const double done : {0.01, 0.3, 0.99, 1.0}) {
        estimator.add(0, 20 * done, {done, 1000, 0});
        CHECK(*estimator.estimate().seconds_left == doctest::Approx(20 * (1 - done)));
        CHECK(estimator.estimate().done == doctest::Approx(done));
    }
}

TEST_CASE("a prepass whose later pixels cost less is not taken for an even one") {
    // Work grows with the root of the share; linear extrapolation would say ten times too much.
    TimeEstimator estimator({{WorkPhase::Kind::prepass, 1000, 1, 1}});
    for (const double done : {0.0001, 0.001, 0.003, 0.01}) {
        const double work = std::sqrt(done);
        estimator.add(
            0, 100 * work,
            {done, static_cast<std::uint64_t>(1e8 * work), static_cast<std::uint64_t>(1e5 * work)});
    }
    CHECK(*estimator.estimate().seconds_left < 90 * 3);
    CHECK(*estimator.estimate().seconds_left > 90 / 3);
}

TEST_CASE("one thread's prepass tells of a picture by many, which is sooner done") {
    double left[2];
    for (const int workers : {1, 10}) {
        TimeEstimator estimator({{WorkPhase::Kind::prepass, 100, 1, 1},
                                 {WorkPhase::Kind::picture, 1e5, 1, static_cast<double>(workers)}});
        estimator.add(0, 1, {1, 1000, 0});
        left[workers == 1 ? 0 : 1] = *estimator.estimate().seconds_left;
    }
    CHECK(left[0] == doctest::Approx(10 * left[1]));
    CHECK(left[0] > 0);
}

TEST_CASE(
    "a plan has a prepass where there is one, which leaves no values where it is deterministic") {
    FrameOptions options;
    options.width = 60;
    options.height = 60;
    CHECK(plan_picture(options, CachePrepass::none, 4).size() == 1);
    const std::vector<WorkPhase> quick = plan_picture(options, CachePrepass::quick, 4);
    REQUIRE(quick.size() == 2);
    CHECK(quick[0].kind == WorkPhase::Kind::prepass);
    CHECK(quick[0].pixels == 100);
    CHECK(quick[0].workers == 4);
    CHECK(quick[1].pixels == 3600);
    CHECK(quick[1].rays < 1);  // a spacing of 4
    const std::vector<WorkPhase> rounds = plan_picture(options, CachePrepass::deterministic, 4);
    CHECK(rounds[0].workers == 4);
    CHECK(quick[1].late_values > 0);
    CHECK(rounds[1].late_values == 0);
    options.pixels.spacing = 1;
    options.pixels.samples = 8;
    CHECK(plan_picture(options, CachePrepass::quick, 4)[0].rays == 1);
    CHECK(plan_picture(options, CachePrepass::quick, 4)[1].rays == 8);
}
