// From shape descriptions to shapes in tracing form: files read, generators run, normals and triangles made, everything
// transformed and moved into scene space.
#pragma once

#include "geometry/error.h"
#include "geometry/shape_set.h"
#include "renderer/scene.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Consumes the meshes of `description`; fills summary.shapes, groups, instances, bounds and array_bytes. Shape i of
/// the description is ShapeId i; those of the groups follow, group after group. Groups that nothing uses are not
/// assembled. Nesting is resolved: an instance of a group that holds instances becomes one of each group that holds
/// shapes. `eye`, the camera's place, says where a scene of planes alone lies. Throws Error (bad_input).
ShapeSet assemble_shapes(SceneDescription& description, const Vec3d& eye, const PrepareOptions& options,
                         SceneSummary& summary, Warnings& warnings);

}  // namespace raytree
