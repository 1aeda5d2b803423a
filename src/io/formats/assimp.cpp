// Reads surfaces of every format that assimp knows. Node transforms are applied, polygons split into
// triangles, and the meshes of a scene joined unless a single one is requested.
#include "io/determinant.hpp"
#include "io/formats/readers.hpp"

#include <assimp/Importer.hpp>
#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <bit>
#include <cmath>

namespace vox::io {
namespace {

// Merges vertices at exactly the same position. File formats and assimp repeat a vertex for every normal,
// texture coordinate or material that it has, which would leave a closed surface open.
class Joiner {
public:
    explicit Joiner(std::vector<double>& positions) : positions_(positions), table_(1024, empty) {}

    std::uint32_t vertex(const double p[3]) {
        const std::size_t count = positions_.size() / 3;
        if (2 * (count + 1) > table_.size()) grow();
        const std::size_t slot = find(p);
        if (table_[slot] == empty) {
            if (count >= max_count) throw Error(VOX_ERROR_LIMIT, "the surface has too many vertices");
            table_[slot] = static_cast<std::uint32_t>(count);
            positions_.insert(positions_.end(), p, p + 3);
        }
        return table_[slot];
    }

private:
    static constexpr std::uint32_t empty = 0xffffffffu;

    std::size_t find(const double p[3]) const {
        std::uint64_t hash = 0;
        for (int k = 0; k < 3; ++k) { // adding 0.0 turns -0 into 0
            hash = (hash ^ std::bit_cast<std::uint64_t>(p[k] + 0.0)) * 0x9e3779b97f4a7c15u;
            hash ^= hash >> 32;
        }
        const std::size_t mask = table_.size() - 1;
        for (std::size_t slot = hash & mask;; slot = (slot + 1) & mask) {
            if (table_[slot] == empty) return slot;
            const double* q = &positions_[3 * static_cast<std::size_t>(table_[slot])];
            if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) return slot;
        }
    }

    void grow() {
        table_.assign(2 * table_.size(), empty);
        for (std::size_t v = 0; v < positions_.size() / 3; ++v)
            table_[find(&positions_[3 * v])] = static_cast<std::uint32_t>(v);
    }

    std::vector<double>& positions_;
    std::vector<std::uint32_t> table_;
};

class Matrix { // 3 x 4, in double
public:
    Matrix() = default;
    Matrix(const Matrix& parent, const aiMatrix4x4& own) {
        const double m[3][4] = {{own.a1, own.a2, own.a3, own.a4},
                                {own.b1, own.b2, own.b3, own.b4},
                                {own.c1, own.c2, own.c3, own.c4}};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 4; ++j) {
                m_[i][j] = j == 3 ? parent.m_[i][3] : 0;
                for (int k = 0; k < 3; ++k) m_[i][j] += parent.m_[i][k] * m[k][j];
            }
    }
    void apply(const aiVector3D& p, double out[3]) const {
        for (int i = 0; i < 3; ++i)
            out[i] = m_[i][0] * static_cast<double>(p.x) + m_[i][1] * static_cast<double>(p.y) +
                     m_[i][2] * static_cast<double>(p.z) + m_[i][3];
    }
    bool mirrors() const { return determinant(m_[0], m_[1], m_[2]) < 0; }

private:
    double m_[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

class SceneReader {
public:
    SceneReader(const aiScene& scene, const std::string& name, std::uint32_t mesh_index)
        : scene_(scene), name_(name), mesh_index_(mesh_index), joiner_(data_.positions) {}

    MeshData read() {
        data_.format = VOX_IO_FORMAT_SURFACE;
        if (mesh_index_ != VOX_IO_ALL_MESHES && mesh_index_ >= scene_.mNumMeshes)
            refuse(format("%s: mesh %u was asked for, but the file holds %u", name_.c_str(), mesh_index_,
                          scene_.mNumMeshes));
        if (scene_.mRootNode) add_node(*scene_.mRootNode);
        if (data_.triangles.empty())
            throw Error(VOX_ERROR_FORMAT, format("%s: expected triangles, found none", name_.c_str()));
        read_unit();
        return std::move(data_);
    }

private:
    void add_node(const aiNode& root) {
        // The stack is explicit because files can nest nodes deeper than the call stack allows.
        struct Entry {
            const aiNode* node;
            Matrix parent;
        };
        std::vector<Entry> stack = {{&root, Matrix()}};
        while (!stack.empty()) {
            const Entry entry = stack.back();
            stack.pop_back();
            const Matrix matrix(entry.parent, entry.node->mTransformation);
            for (unsigned i = 0; i < entry.node->mNumMeshes; ++i) {
                const unsigned mesh = entry.node->mMeshes[i];
                if (mesh >= scene_.mNumMeshes || (mesh_index_ != VOX_IO_ALL_MESHES && mesh != mesh_index_))
                    continue;
                add_mesh(*scene_.mMeshes[mesh], matrix);
            }
            for (unsigned i = entry.node->mNumChildren; i-- > 0;)
                stack.push_back({entry.node->mChildren[i], matrix});
        }
    }

    void add_mesh(const aiMesh& mesh, const Matrix& matrix) {
        const bool mirrors = matrix.mirrors();
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices != 3) {
                ++data_.skipped_elements; // points and lines
                continue;
            }
            std::uint32_t triangle[3];
            for (unsigned i = 0; i < 3; ++i) {
                if (face.mIndices[i] >= mesh.mNumVertices)
                    throw Error(VOX_ERROR_FORMAT,
                                format("%s: face %u: expected a vertex from 0 to %u, found %u", name_.c_str(),
                                       f, mesh.mNumVertices - 1, face.mIndices[i]));
                double p[3];
                matrix.apply(mesh.mVertices[face.mIndices[i]], p);
                if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
                    throw Error(
                        VOX_ERROR_FORMAT,
                        format("%s: face %u: expected a position, found a coordinate that is not finite",
                               name_.c_str(), f));
                triangle[i] = joiner_.vertex(p);
            }
            if (mirrors) std::swap(triangle[1], triangle[2]);
            if (data_.triangles.size() / 3 >= max_count)
                throw Error(VOX_ERROR_LIMIT, format("%s: too many triangles", name_.c_str()));
            data_.triangles.insert(data_.triangles.end(), triangle, triangle + 3);
        }
    }

    // FBX states its unit in centimetres; glTF is in metres by definition.
    void read_unit() {
        if (!scene_.mMetaData) return;
        double centimetres = 0;
        float single = 0;
        if (scene_.mMetaData->Get("UnitScaleFactor", centimetres))
            data_.unit_in_metres = centimetres / 100;
        else if (scene_.mMetaData->Get("UnitScaleFactor", single))
            data_.unit_in_metres = static_cast<double>(single) / 100;
        aiString source;
        if (scene_.mMetaData->Get(AI_METADATA_SOURCE_FORMAT, source) &&
            std::string_view(source.C_Str()).starts_with("glTF"))
            data_.unit_in_metres = 1;
        if (!std::isfinite(data_.unit_in_metres) || data_.unit_in_metres < 0) data_.unit_in_metres = 0;
    }

    const aiScene& scene_;
    const std::string& name_;
    std::uint32_t mesh_index_;
    MeshData data_;
    Joiner joiner_;
};

constexpr unsigned steps = aiProcess_Triangulate;

// assimp would otherwise make a mesh of the skeleton of a scene that has no meshes.
void configure(Assimp::Importer& importer) {
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
}

MeshData convert(Assimp::Importer& importer, const aiScene* scene, const std::string& name,
                 std::uint32_t mesh_index) {
    if (!scene || !scene->mRootNode)
        throw Error(VOX_ERROR_FORMAT, format("%s: expected a surface, found this: %s", name.c_str(),
                                             printable(importer.GetErrorString(), 400).c_str()));
    return SceneReader(*scene, name, mesh_index).read();
}

} // namespace

bool is_surface_extension(const std::string& extension) {
    if (extension.empty() || extension.find_first_of("/\\*;") != std::string::npos) return false;
    return Assimp::Importer().IsExtensionSupported("." + extension);
}

MeshData read_surface(const File& file, const std::string& extension, std::uint32_t mesh_index) {
    Assimp::Importer importer;
    configure(importer);
    const aiScene* scene =
        importer.ReadFileFromMemory(file.bytes.data(), file.bytes.size(), steps, extension.c_str());
    return convert(importer, scene, file.name, mesh_index);
}

MeshData read_surface_at(const std::string& path, std::uint32_t mesh_index) {
    Assimp::Importer importer;
    configure(importer);
    const aiScene* scene = importer.ReadFile(path, steps);
    return convert(importer, scene, path, mesh_index);
}

} // namespace vox::io
