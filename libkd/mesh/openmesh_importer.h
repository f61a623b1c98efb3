// The receiving end of OpenMesh's readers: plain arrays that take any face, manifold or not. Everything that is neither
// a position, a normal nor a face is ignored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>

#include "core/vec.h"
#include "mesh/watch.h"

namespace kd::mesh {

class OpenMeshImporter final : public OpenMesh::IO::BaseImporter {
  using Vertex = OpenMesh::VertexHandle;
  using Halfedge = OpenMesh::HalfedgeHandle;
  using Edge = OpenMesh::EdgeHandle;
  using Face = OpenMesh::FaceHandle;
  using Status = OpenMesh::Attributes::StatusInfo;
  using Vec2f = OpenMesh::Vec2f;
  using Float3 = OpenMesh::Vec3f;
  using Double3 = OpenMesh::Vec3d;
  using Float4 = OpenMesh::Vec4f;
  using Byte3 = OpenMesh::Vec3uc;
  using Byte4 = OpenMesh::Vec4uc;

 public:
  explicit OpenMeshImporter(Watch& watch) : watch_(watch) {}

  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;     // one per position, or none; as long as in the file
  std::vector<int32_t> corners;   // of all faces, unchecked
  std::vector<size_t> face_ends;  // per face: where its corners end

  using BaseImporter::add_vertex;
  Vertex add_vertex(const Float3& p) override { return add({p[0], p[1], p[2]}); }
  Vertex add_vertex(const Double3& p) override { return add({p[0], p[1], p[2]}); }
  Vertex add_vertex() override { return add({0, 0, 0}); }
  void set_point(Vertex v, const Float3& p) override { positions[index(v)] = {p[0], p[1], p[2]}; }
  void set_normal(Vertex v, const Float3& n) override { keep_normal(v, {n[0], n[1], n[2]}); }
  void set_normal(Vertex v, const Double3& n) override { keep_normal(v, {n[0], n[1], n[2]}); }
  Face add_face(const VHandles& vertices) override {
    watch_.step();
    for (const Vertex v : vertices) corners.push_back(v.idx());
    face_ends.push_back(corners.size());
    return Face(static_cast<int>(face_ends.size() - 1));
  }
  void reserve(unsigned vertices, unsigned, unsigned faces) override {
    positions.reserve(vertices);
    corners.reserve(size_t{3} * faces);
    face_ends.reserve(faces);
  }
  bool is_triangle_mesh() const override { return false; }
  size_t n_vertices() const override { return positions.size(); }
  size_t n_faces() const override { return face_ends.size(); }
  size_t n_edges() const override { return 0; }

  Halfedge add_edge(Vertex, Vertex) override { return Halfedge(); }
  Face add_face(Halfedge) override { return Face(); }
  void add_face_texcoords(Face, Vertex, const std::vector<Vec2f>&) override {}
  void add_face_texcoords(Face, Vertex, const std::vector<Float3>&) override {}
  void set_face_texindex(Face, int) override {}
  void set_halfedge(Vertex, Halfedge) override {}
  void set_color(Vertex, const Byte3&) override {}
  void set_color(Vertex, const Byte4&) override {}
  void set_color(Vertex, const Float3&) override {}
  void set_color(Vertex, const Float4&) override {}
  void set_texcoord(Vertex, const Vec2f&) override {}
  void set_texcoord(Vertex, const Float3&) override {}
  void set_status(Vertex, const Status&) override {}
  void set_next(Halfedge, Halfedge) override {}
  void set_face(Halfedge, Face) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(Halfedge, const Vec2f&) override {}
  void set_texcoord(Halfedge, const Float3&) override {}
  void set_status(Halfedge, const Status&) override {}
  void set_color(Edge, const Byte3&) override {}
  void set_color(Edge, const Byte4&) override {}
  void set_color(Edge, const Float3&) override {}
  void set_color(Edge, const Float4&) override {}
  void set_status(Edge, const Status&) override {}
  void set_normal(Face, const Float3&) override {}
  void set_normal(Face, const Double3&) override {}
  void set_color(Face, const Byte3&) override {}
  void set_color(Face, const Byte4&) override {}
  void set_color(Face, const Float3&) override {}
  void set_color(Face, const Float4&) override {}
  void set_status(Face, const Status&) override {}
  void add_texture_information(int, std::string) override {}

 private:
  static size_t index(Vertex v) { return static_cast<size_t>(v.idx()); }
  Vertex add(Vec3d p) {
    watch_.step();
    positions.push_back(p);
    return Vertex(static_cast<int>(positions.size() - 1));
  }
  void keep_normal(Vertex v, Vec3d n) {
    normals.resize(positions.size());
    normals[index(v)] = n;
  }

  Watch& watch_;
};

}  // namespace kd::mesh
