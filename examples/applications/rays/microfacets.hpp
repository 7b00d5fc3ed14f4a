// SPDX-License-Identifier: MIT
//
// How much light the facets of a rough metal reflect, by quadrature in doubles: the reference of the fit in scattering.sk.
#pragma once

namespace rays {

/// The directional albedo of GGX facets of this roughness (0 < alpha <= 1) that reflect light once, under Smith's masking and shadowing with
/// correlated heights (E. Heitz, "Understanding the masking-shadowing function in microfacet-based BRDFs", 2014). `cosine` is the cosine of the
/// viewer's angle with the normal, and `normal` the reflectance at normal incidence in Schlick's approximation; 1 is the white lobe. Takes
/// side x side visible normals; with 128 a side the result is within 1e-4.
double reflectedOnce(double cosine, double alpha, double normal = 1.0, int side = 128);

/// The albedo with the light that facets send to each other, after E. Turquin, "Practical multiple scattering compensation for microfacet models" (2019).
double reflectedInAll(double cosine, double alpha, double normal = 1.0);

}  // namespace rays
