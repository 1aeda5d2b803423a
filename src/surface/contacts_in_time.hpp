// When the candidates of a motion come into contact.
#pragma once

#include "base/array.hpp"
#include "base/parallel.hpp"
#include "surface/contact_time.hpp"
#include "surface/gathered.hpp"
#include "surface/pairs.hpp"
#include "surface/topology.hpp"

#include <vox/vox_surface.h>

#include <memory_resource>

namespace vox {

// Lowers `found` to the first contact among these pairs, if that is before found.step, or at the same time
// and before it in the order of kinds, a, b. What it finds depends neither on workers nor on their order.
void first_contact(const SurfaceTopology& topology, const SurfaceMotion& motion, vox_feature a, vox_feature b,
                   const FeaturePairs& pairs, const ContactTimeRule& rule, Workers& workers,
                   vox_safe_step& found);

// Appends those that may come into contact within the motion, in their order.
void all_contacts(const SurfaceTopology& topology, const SurfaceMotion& motion, vox_feature a, vox_feature b,
                  const FeaturePairs& pairs, const ContactTimeRule& rule, Workers& workers,
                  Gathered<vox_impact>& gathered, Array<vox_impact>& out);

} // namespace vox
