// Reads surfaces of every format that assimp knows. Transforms of nodes are applied, polygons split into
// triangles, and the meshes of a scene joined unless a single one is requested.
#include "io/formats/placement.hpp"
#include "io/formats/readers.hpp"
#include "io/formats/surface_builder.hpp"

#include <assimp/Importer.hpp>
#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <cmath>

namespace vox::io {
namespace {

Placement placement_of(const aiMatrix4x4& m) {
    return {{{m.a1, m.a2, m.a3, m.a4}, {m.b1, m.b2, m.b3, m.b4}, {m.c1, m.c2, m.c3, m.c4}}};
}

class SceneReader {
public:
    SceneReader(const aiScene& scene, const std::string& name, std::uint32_t mesh_index)
        : scene_(scene), name_(name), mesh_index_(mesh_index),
          surface_(name, {max_count, max_count}, all_meshes) {}

    MeshData read() {
        if (mesh_index_ != all_meshes && mesh_index_ >= scene_.mNumMeshes)
            refuse(format("%s: mesh %u was asked for, but the file holds %u", name_.c_str(), mesh_index_ + 1,
                          scene_.mNumMeshes));
        if (scene_.mRootNode) add_node(*scene_.mRootNode);
        MeshData data = surface_.finish();
        data.unit_in_metres = unit();
        return data;
    }

private:
    void add_node(const aiNode& root) {
        // The stack is explicit because files can nest nodes deeper than the call stack allows.
        struct Entry {
            const aiNode* node;
            Placement parent;
        };
        std::vector<Entry> stack = {{&root, Placement()}};
        while (!stack.empty()) {
            const Entry entry = stack.back();
            stack.pop_back();
            const Placement world = entry.parent.of(placement_of(entry.node->mTransformation));
            for (unsigned i = 0; i < entry.node->mNumMeshes; ++i) {
                const unsigned mesh = entry.node->mMeshes[i];
                if (mesh >= scene_.mNumMeshes || (mesh_index_ != all_meshes && mesh != mesh_index_)) continue;
                add_mesh(*scene_.mMeshes[mesh], world);
            }
            for (unsigned i = entry.node->mNumChildren; i-- > 0;)
                stack.push_back({entry.node->mChildren[i], world});
        }
    }

    void add_mesh(const aiMesh& mesh, const Placement& world) {
        const bool mirrors = world.mirrors();
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices != 3) {
                surface_.skip(1); // points and lines
                continue;
            }
            std::uint32_t triangle[3];
            for (unsigned i = 0; i < 3; ++i) {
                if (face.mIndices[i] >= mesh.mNumVertices)
                    throw_error(VOX_ERROR_FORMAT, "%s: face %u: expected a vertex from 0 to %u, found %u",
                                name_.c_str(), f, mesh.mNumVertices - 1, face.mIndices[i]);
                const aiVector3D& at = mesh.mVertices[face.mIndices[i]];
                const double own[3] = {at.x, at.y, at.z};
                double p[3];
                world.apply(own, p);
                if (!is_finite(p))
                    throw_error(VOX_ERROR_FORMAT,
                                "%s: face %u: expected a position, found a coordinate that is not finite",
                                name_.c_str(), f);
                triangle[i] = surface_.vertex(p);
            }
            if (mirrors) std::swap(triangle[1], triangle[2]);
            surface_.triangle(triangle[0], triangle[1], triangle[2]);
        }
    }

    // FBX states its unit in centimetres; glTF is in metres by definition.
    double unit() const {
        if (!scene_.mMetaData) return 0;
        double centimetres = 0;
        float single = 0;
        if (!scene_.mMetaData->Get("UnitScaleFactor", centimetres) &&
            scene_.mMetaData->Get("UnitScaleFactor", single))
            centimetres = static_cast<double>(single);
        aiString source;
        if (scene_.mMetaData->Get(AI_METADATA_SOURCE_FORMAT, source) &&
            std::string_view(source.C_Str()).starts_with("glTF"))
            return 1;
        return std::isfinite(centimetres) && centimetres > 0 ? centimetres / 100 : 0;
    }

    const aiScene& scene_;
    const std::string& name_;
    std::uint32_t mesh_index_;
    SurfaceBuilder surface_;
};

constexpr unsigned steps = aiProcess_Triangulate;

// assimp would otherwise make a mesh of the skeleton of a scene that has no meshes.
void configure(Assimp::Importer& importer) {
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
}

MeshData convert(Assimp::Importer& importer, const aiScene* scene, const std::string& name,
                 std::uint32_t mesh_index) {
    const std::string extension = extension_of(name);
    const bool known = !extension.empty() && extension.find_first_of("*;") == std::string::npos &&
                       importer.IsExtensionSupported("." + extension);
    if (!scene && !known)
        throw_error(VOX_ERROR_UNSUPPORTED,
                    "%s: expected a surface that assimp reads, found neither known "
                    "content nor a known extension",
                    name.c_str());
    if (!scene || !scene->mRootNode)
        throw_error(VOX_ERROR_FORMAT, "%s: expected a surface, found this: %s", name.c_str(),
                    printable(importer.GetErrorString(), 400).c_str());
    return SceneReader(*scene, name, mesh_index).read();
}

} // namespace

MeshData read_by_assimp(const File& file, const std::string& extension, std::uint32_t mesh_index) {
    Assimp::Importer importer;
    configure(importer);
    const aiScene* scene =
        importer.ReadFileFromMemory(file.bytes.data(), file.bytes.size(), steps, extension.c_str());
    return convert(importer, scene, file.name, mesh_index);
}

MeshData read_by_assimp_at(const std::string& path, std::uint32_t mesh_index) {
    Assimp::Importer importer;
    configure(importer);
    const aiScene* scene = importer.ReadFile(path, steps);
    return convert(importer, scene, path, mesh_index);
}

} // namespace vox::io
