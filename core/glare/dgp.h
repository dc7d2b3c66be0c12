#pragma once
// Daylight glare probability: the share of people whom the daylight before them disturbs.
#include "core/math/vec3.h"
#include "core/view/view.h"

namespace lightwalk {

/// How much less a source disturbs that stands off the line of sight: Guth's position index. 1 on
/// the line of sight, larger elsewhere, at most 16.
/// @param direction  unit, to the source, before the eye (not behind the view's plane)
/// @param camera     the eye: its forward and upward axes
/// Above the line of sight: Guth, "A method for the evaluation of discomfort glare", Illuminating
/// Engineering 58 (1963), in the closed form of the IES Lighting Handbook. Below it Guth measured
/// nothing; there sources disturb more than as far above (Iwata & Tokura, "Position index for a
/// glare source located below the line of vision", Lighting Research & Technology 29, 1997). As in
/// the reference evaluation since 2010 (Iwata & Osterhaus, CIE conference 2010), they count as if
/// they stood beside the line of sight; their height below it is taken 1.15 times, the factor that
/// reproduces the reference program's figures within 0.1 %.
[[nodiscard]] double position_index(const Vec3& direction, const Camera& camera);

/// DGP = 5.87e-5 Ev + 0.0918 log10(1 + sum / Ev^1.87) + 0.16, at most 1.
/// @param ev   vertical illuminance at the eye [lx], not negative
/// @param sum  over the sources, of L² ω / P² [cd²/m⁴ sr]; 0 without sources
/// Source: Wienold & Christoffersen, "Evaluation methods and development of a new glare prediction
/// model for daylight environments with the use of CCD cameras", Energy and Buildings 38 (2006).
[[nodiscard]] double daylight_glare_probability(double ev, double sum);

/// How much DGP changes with each of the two; nothing where it is at its most.
struct DgpSlopes {
    double ev = 0;   ///< [1/lx]
    double sum = 0;  ///< [m⁴/(cd² sr)]
};
[[nodiscard]] DgpSlopes dgp_slopes(double ev, double sum);

/// Factor that corrects DGP for dim surroundings, in which the formula of 2006 overestimates glare:
/// e^x / (1 + e^x), x = 0.024 Ev - 4; 0.9997 at 500 lx, 0.018 at 0 lx. Source: Wienold, "Dynamic
/// daylight glare evaluation", Building Simulation 2009.
[[nodiscard]] double low_light_correction(double ev);

/// Whether DGP is within the range of the assessments by people from which its formula was derived:
/// DGP from 0.2 to 0.8 in at least 380 lx at the eye; outside it is an extrapolation. Source:
/// Wienold & Christoffersen 2006, Wienold 2009.
[[nodiscard]] bool within_assessments(double dgp, double ev);

/// How most people judge the glare of a DGP up to 0.35, 0.40, 0.45, and above. Source: Wienold,
/// "Dynamic daylight glare evaluation", Building Simulation 2009.
enum class GlareClass { imperceptible, perceptible, disturbing, intolerable };
[[nodiscard]] GlareClass glare_class(double dgp);

}  // namespace lightwalk
