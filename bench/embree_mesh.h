// Triangles into an Embree scene. For sources that are compiled only where Embree 3 is at hand.
#pragma once

#include <array>
#include <cstdint>

#include <embree3/rtcore.h>

#include "core/vec.h"

namespace kd::bench {

/// Attaches a mesh whose buffers are Embree's: vertex(i) is a Vec3f, triangle(i) an array of three indices. False if
/// there is no memory for them.
template <class VertexOf, class TriangleOf>
bool attach_mesh(RTCDevice device, RTCScene scene, size_t vertex_count, const VertexOf& vertex, size_t triangle_count,
                 const TriangleOf& triangle) {
  using Corners = std::array<uint32_t, 3>;
  RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<Vec3f*>(
      rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), vertex_count));
  auto* triangles = static_cast<Corners*>(
      rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Corners), triangle_count));
  if (vertices && triangles) {
    for (size_t i = 0; i < vertex_count; ++i) vertices[i] = vertex(i);
    for (size_t i = 0; i < triangle_count; ++i) triangles[i] = triangle(i);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
  }
  rtcReleaseGeometry(mesh);
  return vertices && triangles;
}

}  // namespace kd::bench
