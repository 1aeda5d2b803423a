using System;
using System.Runtime.InteropServices;

namespace Voxtet
{
    /// <summary>Mesh files and ready-made bodies (vox_io). A mesh never changes.</summary>
    public sealed unsafe class MeshFile : IDisposable
    {
        readonly MeshFileHandle handle;

        MeshFile(Result result, IntPtr mesh)
        {
            VoxException.Check(result);
            handle = new MeshFileHandle(mesh);
        }

        public void Dispose() { handle.Dispose(); }

        /// <summary>Reads a file of any format that docs/file-formats.md lists.</summary>
        public static MeshFile Load(string path)
        {
            IntPtr mesh;
            fixed (byte* p = VoxException.Utf8(path)) return new MeshFile(Native.vox_io_load((IntPtr)p, null, &mesh), mesh);
        }

        /// <summary>The same from memory. The name tells the format where the bytes do not.</summary>
        public static MeshFile Read(string name, byte[] bytes)
        {
            if (bytes == null) throw new ArgumentNullException("bytes");
            IntPtr mesh;
            fixed (byte* n = VoxException.Utf8(name))
            fixed (byte* b = bytes)
            {
                IoSource source;
                source.name = (IntPtr)n;
                source.data = (IntPtr)b;
                source.size = (UIntPtr)bytes.Length;
                return new MeshFile(Native.vox_io_read(&source, (UIntPtr)1u, null, &mesh), mesh);
            }
        }

        /// <summary>Of arrays, which are copied: three numbers a vertex, four indices a tetrahedron, three a triangle.</summary>
        public static MeshFile Create(double[] positions, uint[] tets, uint[] triangles)
        {
            if (positions == null) throw new ArgumentNullException("positions");
            if (positions.Length % 3 != 0 || tets != null && tets.Length % 4 != 0 || triangles != null && triangles.Length % 3 != 0)
                throw new ArgumentException("expected 3 numbers a vertex, 4 indices a tetrahedron and 3 a triangle");
            IntPtr mesh;
            fixed (double* p = positions)
            fixed (uint* t = tets)
            fixed (uint* f = triangles)
            {
                IoMeshView view;
                view.positions = p;
                view.vertex_count = (ulong)positions.Length / 3;
                view.tets = t;
                view.tet_count = tets == null ? 0 : (ulong)tets.Length / 4;
                view.triangles = f;
                view.triangle_count = triangles == null ? 0 : (ulong)triangles.Length / 3;
                return new MeshFile(Native.vox_io_mesh_create(&view, &mesh), mesh);
            }
        }

        /// <summary>How good it is, and how close to a surface if one is given.</summary>
        public IoQuality GetQuality(MeshFile surface = null)
        {
            IoQuality quality;
            quality.struct_size = (uint)sizeof(IoQuality);
            using (var use = handle.Read())
            {
                if (surface == null)
                    VoxException.Check(Native.vox_io_mesh_measure(use.Pointer, IntPtr.Zero, &quality));
                else
                    using (var other = surface.handle.Read())
                        VoxException.Check(Native.vox_io_mesh_measure(use.Pointer, other.Pointer, &quality));
            }
            return quality;
        }

        /// <summary>A ball of about that many equal tetrahedra.</summary>
        public static MeshFile LatticeBall(ulong tets, double radius)
        {
            IntPtr mesh;
            return new MeshFile(Native.vox_io_make_lattice_ball(tets, radius, &mesh), mesh);
        }

        /// <summary>A ball made of cubes with edge `cell`.</summary>
        public static MeshFile Ball(double radius, double cell)
        {
            IntPtr mesh;
            return new MeshFile(Native.vox_io_make_ball(radius, cell, &mesh), mesh);
        }

        /// <summary>A torus around the z axis.</summary>
        public static MeshFile Torus(double radius, double tubeRadius, double cell)
        {
            IntPtr mesh;
            return new MeshFile(Native.vox_io_make_torus(radius, tubeRadius, cell, &mesh), mesh);
        }

        /// <summary>A capsule along the z axis.</summary>
        public static MeshFile Capsule(double radius, double length, double cell)
        {
            IntPtr mesh;
            return new MeshFile(Native.vox_io_make_capsule(radius, length, cell, &mesh), mesh);
        }

        /// <summary>A cylinder along the z axis.</summary>
        public static MeshFile Cylinder(double radius, double length, double cell)
        {
            IntPtr mesh;
            return new MeshFile(Native.vox_io_make_cylinder(radius, length, cell, &mesh), mesh);
        }

        /// <summary>A box.</summary>
        public static MeshFile Box(double sizeX, double sizeY, double sizeZ, double cell)
        {
            IntPtr mesh;
            return new MeshFile(Native.vox_io_make_box(sizeX, sizeY, sizeZ, cell, &mesh), mesh);
        }

        /// <summary>Fills the inside of this closed surface with tetrahedra; cell 0: a fiftieth of its longest side.</summary>
        public MeshFile Tetrahedralize(double cell = 0, double maxDistance = 0, IoSolidKind kind = IoSolidKind.Stuffed)
        {
            var desc = new IoTetrahedralizeDesc
            {
                struct_size = (uint)sizeof(IoTetrahedralizeDesc), cell = cell, max_distance = maxDistance, kind = kind
            };
            IntPtr mesh;
            using (var use = handle.Read())
                return new MeshFile(Native.vox_io_tetrahedralize(use.Pointer, &desc, &mesh), mesh);
        }

        /// <summary>Three numbers a vertex.</summary>
        public double[] GetPositions()
        {
            using (var use = handle.Read())
            {
                IoMeshView view;
                VoxException.Check(Native.vox_io_mesh_get_arrays(use.Pointer, &view));
                return new ReadOnlySpan<double>(view.positions, checked((int)(3 * view.vertex_count))).ToArray();
            }
        }

        /// <summary>The same as floats.</summary>
        public float[] GetFloatPositions()
        {
            return Array.ConvertAll(GetPositions(), x => (float)x);
        }

        /// <summary>Four indices a tetrahedron.</summary>
        public uint[] GetTets()
        {
            using (var use = handle.Read())
            {
                IoMeshView view;
                VoxException.Check(Native.vox_io_mesh_get_arrays(use.Pointer, &view));
                return new ReadOnlySpan<uint>(view.tets, checked((int)(4 * view.tet_count))).ToArray();
            }
        }

        /// <summary>The triangles of the file, three indices each.</summary>
        public uint[] GetTriangles()
        {
            using (var use = handle.Read())
            {
                IoMeshView view;
                VoxException.Check(Native.vox_io_mesh_get_arrays(use.Pointer, &view));
                return new ReadOnlySpan<uint>(view.triangles, checked((int)(3 * view.triangle_count))).ToArray();
            }
        }

        /// <summary>A number for each tetrahedron; null where the file has none that is not 0.</summary>
        public int[] GetTetRegions()
        {
            using (var use = handle.Read())
            {
                IoMeshView view;
                VoxException.Check(Native.vox_io_mesh_get_arrays(use.Pointer, &view));
                if (view.tet_regions == null) return null;
                return new ReadOnlySpan<int>(view.tet_regions, checked((int)view.tet_count)).ToArray();
            }
        }

        /// <summary>For each vertex its number in the file; null where no vertex was left out.</summary>
        public uint[] GetFileVertices()
        {
            using (var use = handle.Read())
            {
                IoMeshView view;
                VoxException.Check(Native.vox_io_mesh_get_arrays(use.Pointer, &view));
                if (view.file_vertices == null) return null;
                return new ReadOnlySpan<uint>(view.file_vertices, checked((int)view.vertex_count)).ToArray();
            }
        }

        /// <summary>For each tetrahedron the number of its cell in the file; null where that is its own.</summary>
        public uint[] GetTetCells()
        {
            using (var use = handle.Read())
            {
                IoMeshView view;
                VoxException.Check(Native.vox_io_mesh_get_arrays(use.Pointer, &view));
                if (view.tet_cells == null) return null;
                return new ReadOnlySpan<uint>(view.tet_cells, checked((int)view.tet_count)).ToArray();
            }
        }

        /// <summary>What was read, and what is odd about it.</summary>
        public IoReport Report
        {
            get
            {
                IoReport report;
                report.struct_size = (uint)sizeof(IoReport);
                using (var use = handle.Read()) VoxException.Check(Native.vox_io_mesh_get_report(use.Pointer, &report));
                return report;
            }
        }

        /// <summary>What is odd about it in words, a line each.</summary>
        public string Warnings
        {
            get { using (var use = handle.Read()) return VoxException.Text(Native.vox_io_mesh_get_warnings(use.Pointer)); }
        }

        /// <summary>Writes .msh or .vtu.</summary>
        public void Save(string path)
        {
            fixed (byte* p = VoxException.Utf8(path))
            using (var use = handle.Read())
                VoxException.Check(Native.vox_io_write(use.Pointer, (IntPtr)p, null));
        }
    }
}
