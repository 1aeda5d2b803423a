// Written by bindings/generate.py from bindings/api.json. Do not edit.
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;

namespace Voxtet
{
    // Names and layouts are those of vox.h, vox_query.h, vox_cell_size.h, vox_surface.h, vox_io.h and vox_sim.h.

    public enum Result : int
    {
        Ok = 0,
        /// <summary>a null pointer, an unknown enumerator, a bad number</summary>
        ErrorInvalidArgument = -1,
        /// <summary>an id that is null, stale or of another grid</summary>
        ErrorInvalidHandle = -2,
        /// <summary>a tetrahedron or triangle names a vertex that does not exist</summary>
        ErrorInvalidMesh = -3,
        /// <summary>the call does not fit the state, e.g. a mesh has no positions yet</summary>
        ErrorInvalidState = -4,
        /// <summary>a position is NaN or infinite</summary>
        ErrorNonFinite = -5,
        /// <summary>a documented limit would be exceeded</summary>
        ErrorLimit = -6,
        /// <summary>the byte budget would be exceeded</summary>
        ErrorBudget = -7,
        /// <summary>the allocator returned null</summary>
        ErrorOutOfMemory = -8,
        /// <summary>not in this build or version</summary>
        ErrorUnsupported = -9,
        /// <summary>a file cannot be opened, read or written</summary>
        ErrorFile = -10,
        /// <summary>a file or a snapshot is malformed</summary>
        ErrorFormat = -11,
        /// <summary>a defect of the library: please report it</summary>
        ErrorInternal = -12,
    }

    public enum Format : int
    {
        Float = 0,
        /// <summary>magnitudes below 2^128 - 2^103, the largest float</summary>
        Double = 1,
    }

    /// <summary>What a step does besides finding contacts and pairs.</summary>
    [Flags]
    public enum GridFlags : uint
    {
        /// <summary>also find constraints: as vox_grid_find_constraints with the defaults</summary>
        Constraints = 1,
        /// <summary>also find edges that pass through faces.</summary>
        Edges = 2,
        /// <summary>leave out a body with a bad coordinate (NaN, infinite, too large) instead of failing
        /// (vox_grid_get_failure)</summary>
        SkipBadBodies = 4,
    }

    [Flags]
    public enum FilterFlags : uint
    {
        /// <summary>the mesh also collides with itself</summary>
        SelfCollision = 1,
        /// <summary>the body has contacts and pairs, but no constraints; takes less memory</summary>
        Sensor = 2,
    }

    [Flags]
    public enum MeshFlags : uint
    {
        /// <summary>copy the positions instead of borrowing them</summary>
        CopyPositions = 1,
        /// <summary>borrow the tetrahedra instead of copying them, 16 bytes each</summary>
        BorrowTets = 2,
    }

    /// <summary>What changed since the last successful step.</summary>
    public enum PairState : int
    {
        /// <summary>does not touch, but is within the margin</summary>
        Near = 0,
        /// <summary>touches now and did not before</summary>
        Began = 1,
        /// <summary>touches now and did before</summary>
        Persisted = 2,
        /// <summary>touched before and does not now</summary>
        Ended = 3,
    }

    /// <summary>Why there is a constraint.</summary>
    public enum ConstraintKind : int
    {
        /// <summary>a vertex of body_a is inside body_b</summary>
        Inside = 0,
        /// <summary>an edge of body_a meets a face of body_b (VOX_GRID_EDGES)</summary>
        Edge = 1,
        /// <summary>a vertex of body_a is outside body_b and within the margin (vox_grid_set_margin)</summary>
        Proximity = 2,
        /// <summary>a vertex of body_a is not inside body_b, but went in within the step and is behind the face that it
        /// met first (vox_mesh_bind_previous_positions)</summary>
        Impact = 3,
    }

    /// <summary>How gap and normal were found, and thus how far to trust them (docs/depth.md).</summary>
    public enum DepthState : int
    {
        /// <summary>a mean over the edges that lead from the vertex out of body_b</summary>
        Surface = 0,
        /// <summary>a mean over neighbouring vertices that are closer to the surface</summary>
        Propagated = 1,
        /// <summary>the closest point of the surface, which may jump from step to step</summary>
        Closest = 2,
        /// <summary>the bodies pass through each other: the nearest way out, which may be the wrong side</summary>
        Ambiguous = 3,
        /// <summary>the bodies only touch here: gap 0</summary>
        Touching = 4,
        /// <summary>closest_budget was used up: gap 0; or no depth was asked for: gap and normal 0</summary>
        Unknown = 5,
        /// <summary>the plane of the face: for IMPACT, and for EDGE of a mesh with itself</summary>
        Plane = 6,
    }

    /// <summary>How the depth of a vertex inside a mesh is found.</summary>
    public enum DepthMethod : int
    {
        /// <summary>smooth along the surface; neighbouring vertices leave on the same side: for response (Heidelberger
        /// et al. 2004)</summary>
        Consistent = 0,
        /// <summary>to the closest point of the surface, with the vertices of its face in place of the tetrahedron's:
        /// for finite elements, pictures, reports</summary>
        Closest = 1,
        /// <summary>none: vertices, weights and position alone.</summary>
        None = 2,
    }

    /// <summary>Shapes are given in a frame of their own. vox_body_set_transform places them, and moves them from step
    /// to step.</summary>
    public enum ShapeKind : int
    {
        None = 0,
        /// <summary>z &lt;= 0: a floor</summary>
        HalfSpace = 1,
        /// <summary>around the origin: radius</summary>
        Sphere = 2,
        /// <summary>along the z axis, around the origin: radius, half_length</summary>
        Capsule = 3,
        /// <summary>likewise, with flat ends</summary>
        Cylinder = 4,
        /// <summary>around the origin: half_size</summary>
        Box = 5,
        /// <summary>terrain, solid below, without walls at its ends: heights, columns, rows, spacing</summary>
        Heightfield = 6,
        /// <summary>the inside of a closed surface: positions, triangles</summary>
        Solid = 7,
        /// <summary>what is within `radius` of triangles: a blade, a wall.</summary>
        Sheet = 8,
        /// <summary>where a function of the caller is not positive: field, half_size</summary>
        Field = 9,
    }

    /// <summary>How serious a line of the log is.</summary>
    public enum LogLevel : int
    {
        Info = 0,
        Warning = 1,
    }

    [Flags]
    public enum QueryFlags : uint
    {
        /// <summary>vox_locator_find_ray_hits: report only the first hit of each ray</summary>
        FirstHit = 1,
        /// <summary>vox_locator_locate: for a point outside, compute the weights of the point itself, some of which are
        /// negative, rather than of the closest point</summary>
        Extrapolate = 2,
    }

    public enum LocationState : int
    {
        /// <summary>no body is within max_distance; the other fields are 0</summary>
        None = 0,
        /// <summary>the closed tetrahedron contains the point</summary>
        Inside = 1,
        /// <summary>no tetrahedron contains the point; this one has the closest point of all surfaces, as
        /// vox_locator_find_closest finds it</summary>
        Outside = 2,
    }

    public enum Side : int
    {
        /// <summary>the facet's tetrahedron has no volume</summary>
        None = 0,
        /// <summary>the ray goes into the tetrahedron</summary>
        Enters = 1,
        Leaves = 2,
    }

    /// <summary>What a result depends on, combined with |. vox_cell_size_result.note says it in words, with
    /// numbers.</summary>
    [Flags]
    public enum CellSizeWarnings : uint
    {
        /// <summary>nothing is known of the grid's times; a few timings would help</summary>
        GuessedWeights = 1,
        /// <summary>it is the mean edge: the weights do not show for certain that another is better</summary>
        ByRule = 2,
        /// <summary>it is min_cell_size, though a smaller one would cost less</summary>
        AtMinimum = 4,
        /// <summary>the primitives have no size; it follows from the distances between them</summary>
        FromSpacing = 8,
        /// <summary>all primitives are in one place; any large enough cell size will do</summary>
        OnePlace = 16,
        /// <summary>the timings do not follow the counts of the described grid</summary>
        ModelDisagrees = 32,
        /// <summary>timings at the same cell size differ widely</summary>
        TimingsDisagree = 64,
        /// <summary>the best cell size lies beyond those that were timed</summary>
        OutOfRange = 128,
        /// <summary>the callback stopped, or could not run at a cell size</summary>
        Stopped = 256,
    }

    public enum CostModel : int
    {
        /// <summary>the paper's z(delta) (Sect. 4, Eqs. 3-8)</summary>
        Paper = 0,
        /// <summary>a step of the paper's engine, counted tetrahedron by tetrahedron</summary>
        Reference = 1,
        /// <summary>a step of the fast engine, with the same cell size everywhere</summary>
        Fast = 2,
        /// <summary>the searches of vox_surface.h in the meshes' surfaces</summary>
        Surface = 3,
    }

    [Flags]
    public enum ReferenceFlags : uint
    {
        /// <summary>store a list for every cell of a box, instead of hashing cells into a table</summary>
        Dense = 1,
        /// <summary>hash by i*73856093 xor j*19349663 xor k*83492791 (Teschner et al. 2003, Sect. 4.1), instead of by a
        /// well-mixed hash</summary>
        PaperHash = 2,
    }

    public enum PrimitiveType : int
    {
        /// <summary>one vertex</summary>
        Point = 0,
        /// <summary>two</summary>
        Edge = 1,
        /// <summary>three</summary>
        Triangle = 2,
        /// <summary>four</summary>
        Tet = 3,
        /// <summary>two: opposite corners, in any order</summary>
        Box = 4,
    }

    /// <summary>Grids whose layout and weights are known, as measured by bench/foreign.</summary>
    public enum KnownGrid : int
    {
        /// <summary>the weights with the smallest worst loss over all grids below</summary>
        None = 0,
        /// <summary>C++: a counting sort into a dense lattice</summary>
        Sorted = 1,
        /// <summary>C++: std::unordered_map from cell to list</summary>
        Hashed = 2,
        /// <summary>NVIDIA Warp's HashGrid on the processor</summary>
        Warp = 3,
        /// <summary>IPC Toolkit's SpatialHash</summary>
        Ipc = 4,
        /// <summary>IPC Toolkit's HashGrid</summary>
        IpcPairs = 5,
        /// <summary>VTK's vtkStaticCellLocator</summary>
        Vtk = 6,
        /// <summary>PBAT's HashGrid3</summary>
        Pbat = 7,
        /// <summary>hashed voxels of points, as in PCL and Open3D</summary>
        PointVoxels = 8,
        /// <summary>sorted keys in numpy</summary>
        Numpy = 9,
    }

    /// <summary>The cells that store a primitive.</summary>
    public enum CellsStored : int
    {
        /// <summary>as in the known grid, else BOX</summary>
        Default = 0,
        /// <summary>all cells that its box meets</summary>
        Box = 1,
        /// <summary>the cell that contains the centre of its box</summary>
        Centre = 2,
    }

    /// <summary>The cells that a query visits.</summary>
    public enum CellsQueried : int
    {
        /// <summary>as in the known grid, else BOX</summary>
        Default = 0,
        /// <summary>all cells that its box meets; one for a point</summary>
        Box = 1,
        /// <summary>the cell that contains its centre, and the 26 cells around it.</summary>
        Queried27 = 2,
        /// <summary>none: the grid goes through its cells and reports every pair within a cell</summary>
        Pairs = 3,
    }

    /// <summary>The cells that exist.</summary>
    public enum CellsKept : int
    {
        /// <summary>as in the known grid, else OCCUPIED</summary>
        Default = 0,
        /// <summary>those that store something</summary>
        Occupied = 1,
        /// <summary>all cells in the box of the stored primitives</summary>
        Dense = 2,
    }

    /// <summary>What a surface consists of.</summary>
    public enum Feature : int
    {
        Vertex = 0,
        Edge = 1,
        Face = 2,
    }

    [Flags]
    public enum MotionFlags : uint
    {
        /// <summary>leave out pairs of boxes whose features provably stay further apart than twice the radius</summary>
        Cull = 1,
    }

    public enum CrossingKind : int
    {
        /// <summary>the edge passes through the interior of the face</summary>
        Through = 0,
        /// <summary>an end of the edge is on the face, or it passes through a side or a corner of it</summary>
        Touching = 1,
        /// <summary>it lies in the plane of the face and meets it, or one of them is degenerate</summary>
        Coplanar = 2,
    }

    public enum IoFormat : int
    {
        /// <summary>determined from the content or, failing that, from the name's extension</summary>
        Auto = 0,
        /// <summary>.msh 1, 2.2, 4.0, 4.1; ASCII and binary</summary>
        Gmsh = 1,
        /// <summary>.node with .ele</summary>
        Tetgen = 2,
        /// <summary>.mesh, ASCII</summary>
        Medit = 3,
        /// <summary>.veg</summary>
        Vega = 4,
        /// <summary>legacy .vtk, 2.0 to 5.1; ASCII and binary; tets, or POLYDATA: triangles, no tets</summary>
        Vtk = 5,
        /// <summary>XML .vtu, and .vtp: triangles, no tets; ASCII, base64, appended; raw, zlib, LZ4 or LZMA.</summary>
        Vtu = 6,
        /// <summary>.stl, .obj, .ply, .off, .gltf, .glb; triangles, no tets</summary>
        Surface = 7,
        /// <summary>Any other surface that assimp reads. assimp is not made for damaged files: they can end the
        /// process, keep it busy without end and fill its memory.</summary>
        Assimp = 8,
        /// <summary>.inp; also of CalculiX</summary>
        Abaqus = 9,
    }

    /// <summary>Flags of a vox_io_load_desc.</summary>
    [Flags]
    public enum IoLoadFlags : uint
    {
        /// <summary>Keep vertices that belong to no tet, and triangles that name one.</summary>
        KeepUnused = 1,
        /// <summary>Split hexahedra, wedges (prisms) and pyramids into tets.</summary>
        SplitCells = 2,
    }

    public enum IoSolidKind : int
    {
        /// <summary>Isosurface stuffing: the boundary follows the surface, and dihedral angles are between 10.7 and
        /// 164.8 degrees.</summary>
        Stuffed = 0,
        /// <summary>Every lattice cube that the surface touches or encloses, uncut and split into five tets, so that
        /// the surface is inside.</summary>
        Cubes = 1,
    }

    public enum IoWriteFormat : int
    {
        /// <summary>determined by the name's extension: .msh is MSH_41, .vtu is VTU</summary>
        Auto = 0,
        /// <summary>Gmsh .msh 2.2</summary>
        Msh22 = 1,
        /// <summary>Gmsh .msh 4.1</summary>
        Msh41 = 2,
        /// <summary>VTK XML, for ParaView</summary>
        Vtu = 3,
    }

    [Flags]
    public enum SimBodyFlags : uint
    {
        SelfCollision = 1,
        /// <summary>never moves; others collide with it</summary>
        Fixed = 2,
    }

    [Flags]
    public enum ResolveFlags : uint
    {
        /// <summary>the body does not move</summary>
        Fixed = 1,
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Uint5
    {
        public uint e0, e1, e2, e3, e4;
        public const int Length = 5;
        public uint this[int i]
        {
            get { Check(i); fixed (uint* p = &e0) return p[i]; }
            set { Check(i); fixed (uint* p = &e0) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Double5
    {
        public double e0, e1, e2, e3, e4;
        public const int Length = 5;
        public double this[int i]
        {
            get { Check(i); fixed (double* p = &e0) return p[i]; }
            set { Check(i); fixed (double* p = &e0) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Double3
    {
        public double x, y, z;
        public const int Length = 3;
        public double this[int i]
        {
            get { Check(i); fixed (double* p = &x) return p[i]; }
            set { Check(i); fixed (double* p = &x) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Double12
    {
        public double e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11;
        public const int Length = 12;
        public double this[int i]
        {
            get { Check(i); fixed (double* p = &e0) return p[i]; }
            set { Check(i); fixed (double* p = &e0) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Double2
    {
        public double x, y;
        public const int Length = 2;
        public double this[int i]
        {
            get { Check(i); fixed (double* p = &x) return p[i]; }
            set { Check(i); fixed (double* p = &x) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Double4
    {
        public double x, y, z, w;
        public const int Length = 4;
        public double this[int i]
        {
            get { Check(i); fixed (double* p = &x) return p[i]; }
            set { Check(i); fixed (double* p = &x) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Uint3
    {
        public uint x, y, z;
        public const int Length = 3;
        public uint this[int i]
        {
            get { Check(i); fixed (uint* p = &x) return p[i]; }
            set { Check(i); fixed (uint* p = &x) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Double6
    {
        public double e0, e1, e2, e3, e4, e5;
        public const int Length = 6;
        public double this[int i]
        {
            get { Check(i); fixed (double* p = &e0) return p[i]; }
            set { Check(i); fixed (double* p = &e0) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct CostSample64
    {
        public CostSample e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11, e12, e13, e14, e15, e16, e17, e18, e19, e20,
            e21, e22, e23, e24, e25, e26, e27, e28, e29, e30, e31, e32, e33, e34, e35, e36, e37, e38, e39, e40, e41,
            e42, e43, e44, e45, e46, e47, e48, e49, e50, e51, e52, e53, e54, e55, e56, e57, e58, e59, e60, e61, e62,
            e63;
        public const int Length = 64;
        public CostSample this[int i]
        {
            get { Check(i); fixed (CostSample* p = &e0) return p[i]; }
            set { Check(i); fixed (CostSample* p = &e0) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CostTerm12
    {
        public CostTerm e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11;
        public const int Length = 12;
        public CostTerm this[int i]
        {
            get { Check(i); fixed (CostTerm* p = &e0) return p[i]; }
            set { Check(i); fixed (CostTerm* p = &e0) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CellSizeRule8
    {
        public CellSizeRule e0, e1, e2, e3, e4, e5, e6, e7;
        public const int Length = 8;
        public CellSizeRule this[int i]
        {
            get { Check(i); fixed (CellSizeRule* p = &e0) return p[i]; }
            set { Check(i); fixed (CellSizeRule* p = &e0) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Timing32
    {
        public Timing e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11, e12, e13, e14, e15, e16, e17, e18, e19, e20,
            e21, e22, e23, e24, e25, e26, e27, e28, e29, e30, e31;
        public const int Length = 32;
        public Timing this[int i]
        {
            get { Check(i); fixed (Timing* p = &e0) return p[i]; }
            set { Check(i); fixed (Timing* p = &e0) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Byte256
    {
        public byte e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11, e12, e13, e14, e15, e16, e17, e18, e19, e20, e21,
            e22, e23, e24, e25, e26, e27, e28, e29, e30, e31, e32, e33, e34, e35, e36, e37, e38, e39, e40, e41, e42,
            e43, e44, e45, e46, e47, e48, e49, e50, e51, e52, e53, e54, e55, e56, e57, e58, e59, e60, e61, e62, e63,
            e64, e65, e66, e67, e68, e69, e70, e71, e72, e73, e74, e75, e76, e77, e78, e79, e80, e81, e82, e83, e84,
            e85, e86, e87, e88, e89, e90, e91, e92, e93, e94, e95, e96, e97, e98, e99, e100, e101, e102, e103, e104,
            e105, e106, e107, e108, e109, e110, e111, e112, e113, e114, e115, e116, e117, e118, e119, e120, e121, e122,
            e123, e124, e125, e126, e127, e128, e129, e130, e131, e132, e133, e134, e135, e136, e137, e138, e139, e140,
            e141, e142, e143, e144, e145, e146, e147, e148, e149, e150, e151, e152, e153, e154, e155, e156, e157, e158,
            e159, e160, e161, e162, e163, e164, e165, e166, e167, e168, e169, e170, e171, e172, e173, e174, e175, e176,
            e177, e178, e179, e180, e181, e182, e183, e184, e185, e186, e187, e188, e189, e190, e191, e192, e193, e194,
            e195, e196, e197, e198, e199, e200, e201, e202, e203, e204, e205, e206, e207, e208, e209, e210, e211, e212,
            e213, e214, e215, e216, e217, e218, e219, e220, e221, e222, e223, e224, e225, e226, e227, e228, e229, e230,
            e231, e232, e233, e234, e235, e236, e237, e238, e239, e240, e241, e242, e243, e244, e245, e246, e247, e248,
            e249, e250, e251, e252, e253, e254, e255;
        public const int Length = 256;
        public byte this[int i]
        {
            get { Check(i); fixed (byte* p = &e0) return p[i]; }
            set { Check(i); fixed (byte* p = &e0) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
        public override string ToString()
        {
            fixed (byte* p = &e0)
            {
                int end = 0;
                while (end < 256 && p[end] != 0) ++end;
                return System.Text.Encoding.UTF8.GetString(p, end);
            }
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Double24
    {
        public double e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11, e12, e13, e14, e15, e16, e17, e18, e19, e20,
            e21, e22, e23;
        public const int Length = 24;
        public double this[int i]
        {
            get { Check(i); fixed (double* p = &e0) return p[i]; }
            set { Check(i); fixed (double* p = &e0) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    /// <summary>An array of positions.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Positions
    {
        /// <summary>null: no positions</summary>
        public IntPtr data;
        public ulong count;
        public Format format;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>0: packed; for columns, the size of a number</summary>
        public ulong byte_stride;
        /// <summary>0: the size of a number</summary>
        public ulong component_byte_stride;
    }

    /// <summary>Settings of a grid; all 0 by default.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct GridDesc
    {
        public uint struct_size;
        /// <summary>vox_grid_flags, combined with |</summary>
        public GridFlags flags;
        /// <summary>threads that share a step: up to VOX_MAX_WORKERS, or VOX_ALL_CORES; 0: one</summary>
        public uint worker_count;
        /// <summary>Most constraints of a pair, up to VOX_MAX_CONSTRAINTS_PER_PAIR; 0: all.</summary>
        public uint max_constraints_per_pair;
        /// <summary>edge length of a cell; 0: the library chooses it in every step.</summary>
        public double cell_size;
        /// <summary>see vox_grid_set_margin</summary>
        public double margin;
        /// <summary>most bytes the grid may hold; 0: 4 GiB; UINT64_MAX: no limit</summary>
        public ulong byte_budget;
        /// <summary>null: the C++ runtime's heap</summary>
        public Allocator* allocator;
        /// <summary>null: no log</summary>
        public Log* log;
        /// <summary>null: the built-in scheduler</summary>
        public TaskSystem* tasks;
        /// <summary>null: the fast engine; else the paper's engine, which is slower and finds the same
        /// (vox_cell_size.h)</summary>
        public ReferenceDesc* reference;
    }

    /// <summary>What a body collides with.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 40)]
    public struct Filter
    {
        /// <summary>vox_filter_flags, combined with |</summary>
        public FilterFlags flags;
        public int group;
        /// <summary>0: 1</summary>
        public ulong category;
        /// <summary>0: all bits</summary>
        public ulong mask;
        public uint world;
        /// <summary>Self-contact ignores tetrahedra that have a corner within this many edges of the vertex; at most
        /// VOX_MAX_RINGS.</summary>
        public uint self_rings;
        /// <summary>Self-contact ignores tetrahedra that are closer to the vertex than this in the rest pose.</summary>
        public double self_rest_distance;
    }

    /// <summary>A mesh: vertices, and tetrahedra between them.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct MeshDesc
    {
        public uint struct_size;
        /// <summary>vox_mesh_flags, combined with |</summary>
        public MeshFlags flags;
        /// <summary>positions.count is the number of vertices.</summary>
        public Positions positions;
        /// <summary>4 * tet_count vertex indices, in either winding.</summary>
        public uint* tets;
        public ulong tet_count;
        /// <summary>any number; results repeat it</summary>
        public ulong user_data;
        public Filter filter;
        /// <summary>copied; see vox_filter.self_rest_distance</summary>
        public Positions rest_positions;
    }

    /// <summary>Vertex `vertex` of body_a lies in the closed tetrahedron `tet` of body_b and is not one of its
    /// corners.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 16)]
    public struct Contact
    {
        public uint body_a;
        public uint vertex;
        public uint body_b;
        public uint tet;
    }

    /// <summary>Contacts, sorted by (body_a, vertex, body_b, tet).</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ContactView
    {
        public Contact* data;
        public ulong count;
        /// <summary>one for each contact: 1 if the vertex is in the interior, 0 if on the boundary</summary>
        public byte* interiors;
    }

    /// <summary>Two bodies that touch, or touched in the step before.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 48)]
    public struct Pair
    {
        public uint body_a;
        public uint body_b;
        public ulong user_data_a;
        public ulong user_data_b;
        public PairState state;
        public uint reserved;
        /// <summary>see vox_pair_view.contacts</summary>
        public ulong first_contact;
        /// <summary>0 if the two touch in another way, or no longer</summary>
        public ulong contact_count;
    }

    /// <summary>Pairs, sorted by (body_a, body_b).</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct PairView
    {
        public Pair* data;
        public ulong count;
        /// <summary>indices of contacts.</summary>
        public uint* contacts;
    }

    /// <summary>A point of body_a and a point of body_b that must not pass through each other.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 192)]
    public struct Constraint
    {
        public uint body_a;
        public uint body_b;
        public ConstraintKind kind;
        public DepthState state;
        /// <summary>how many vertices of body_a</summary>
        public uint count_a;
        /// <summary>how many vertices in all</summary>
        public uint count;
        /// <summary>those beyond `count` are 0, and so are their weights</summary>
        public Uint5 vertices;
        /// <summary>tetrahedron of body_b: the lowest that contains the vertex; with a face, the tetrahedron behind
        /// it.</summary>
        public uint element_b;
        /// <summary>of corners of a tetrahedron: rounded as in vox_location (vox_query.h)</summary>
        public Double5 weights;
        /// <summary>a unit vector out of body_b, the way for body_a</summary>
        public Double3 normal;
        public double gap;
        public double offset;
        /// <summary>of the point of body_a</summary>
        public Double3 position;
        /// <summary>when within the step, from 0 to 1, a vertex met the surface; 1 if that is not known</summary>
        public double time;
        public ulong user_data_a;
        public ulong user_data_b;
        /// <summary>index of its pair in vox_grid_get_pairs</summary>
        public uint pair;
        /// <summary>index of the same constraint in the list of the step before, for a warm start; VOX_NONE if it is
        /// new.</summary>
        public uint previous;
        /// <summary>how many more its pair would have without max_constraints_per_pair</summary>
        public ulong left_out;
    }

    /// <summary>Which constraints to find.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 32)]
    public struct ConstraintDesc
    {
        public uint struct_size;
        public DepthMethod method;
        /// <summary>only pairs of this body; VOX_NULL_BODY: all pairs</summary>
        public uint body_a;
        /// <summary>only its pair with body_a; VOX_NULL_BODY: all pairs of body_a</summary>
        public uint body_b;
        /// <summary>only pairs in which the category of a body has a bit in common with it; 0: all pairs</summary>
        public ulong mask;
        /// <summary>most searches for a closest point; constraints that get none are UNKNOWN, and the log has a
        /// warning. 0: no limit</summary>
        public ulong closest_budget;
    }

    /// <summary>Constraints, sorted by pair, then by kind, body_a and vertices; the vertices of a face
    /// ascend.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ConstraintView
    {
        public Constraint* data;
        public ulong count;
        /// <summary>pair_count + 1</summary>
        public ulong* pair_offsets;
        /// <summary>as in vox_pair_view.count</summary>
        public ulong pair_count;
    }

    /// <summary>A body as it is now.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct BodyInfo
    {
        public uint struct_size;
        /// <summary>vox_shape_kind; VOX_SHAPE_NONE for a mesh</summary>
        public uint shape;
        public ulong user_data;
        /// <summary>1 or 0</summary>
        public uint enabled;
        /// <summary>vox_mesh_flags: COPY_POSITIONS if the grid owns the positions, BORROW_TETS while the caller owns
        /// the tetrahedra</summary>
        public MeshFlags flags;
        /// <summary>with disabled and removed ones: indices are below it</summary>
        public ulong tet_count;
        public ulong enabled_tet_count;
        /// <summary>of a mesh, without its transform; valid as long as they stay bound or mapped</summary>
        public Positions positions;
        public Filter filter;
        public Double12 transform;
    }

    /// <summary>A rigid shape.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ShapeDesc
    {
        public uint struct_size;
        public ShapeKind kind;
        public double radius;
        /// <summary>of a capsule, between the centres of its round ends</summary>
        public double half_length;
        /// <summary>half the sides of a box; of a box around the origin that holds the shape of a field</summary>
        public Double3 half_size;
        public Positions positions;
        /// <summary>3 * triangle_count vertex indices; of a SOLID counter-clockwise as seen from outside</summary>
        public uint* triangles;
        public ulong triangle_count;
        /// <summary>columns * rows numbers: z at x = column * spacing[0], y = row * spacing[1] is heights[row * columns
        /// + column].</summary>
        public double* heights;
        public uint columns;
        public uint rows;
        public Double2 spacing;
        /// <summary>Computes the distances of `count` points, x y z each, from the shape in its frame.</summary>
        public IntPtr field;
        /// <summary>passed to `field` as `user`</summary>
        public IntPtr field_user;
        public ulong user_data;
        /// <summary>self-collision, rings and rest distance have no meaning</summary>
        public Filter filter;
    }

    /// <summary>A grid as it is now, and what its last successful step did.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 88)]
    public struct GridInfo
    {
        public uint struct_size;
        /// <summary>vox_grid_flags</summary>
        public GridFlags flags;
        /// <summary>counts up when an epoch ends (see Ownership above)</summary>
        public ulong epoch;
        /// <summary>as it was set, or else as it was used last; 0 before the first step</summary>
        public double cell_size;
        public double margin;
        /// <summary>held now, without the caller's arrays</summary>
        public ulong bytes;
        public ulong peak_bytes;
        /// <summary>nanoseconds</summary>
        public ulong step_ns;
        /// <summary>bodies that were not at rest</summary>
        public ulong moved_bodies;
        /// <summary>bodies that were left out (VOX_GRID_SKIP_BAD_BODIES)</summary>
        public ulong skipped_bodies;
        /// <summary>pairs that began, in all steps so far</summary>
        public ulong total_began;
        /// <summary>pairs that ended, in all steps so far</summary>
        public ulong total_ended;
    }

    /// <summary>A count, or a time in nanoseconds, with its name.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Counter
    {
        /// <summary>static text, e.g. "candidates" or "lookup_ns"</summary>
        public IntPtr name;
        public ulong value;
    }

    /// <summary>Counters.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CounterView
    {
        public Counter* data;
        public ulong count;
    }

    /// <summary>A body that made a step fail, or that a step left out.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 48)]
    public struct Failure
    {
        public uint struct_size;
        /// <summary>VOX_OK: there is no such body</summary>
        public Result result;
        public uint body;
        /// <summary>the first vertex with a bad coordinate; VOX_NONE if the failure is not about a vertex</summary>
        public uint vertex;
        public ulong user_data;
        /// <summary>of that vertex, transformed</summary>
        public Double3 position;
    }

    /// <summary>Vertices to append.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct VerticesDesc
    {
        public uint struct_size;
        /// <summary>0</summary>
        public uint reserved;
        public ulong count;
        /// <summary>In the mesh's format.</summary>
        public Positions positions;
        /// <summary>`count` indices: the vertex whose position and rest position each one gets</summary>
        public uint* copies_of;
        /// <summary>of the new vertices, if the mesh has a rest pose.</summary>
        public Positions rest_positions;
    }

    /// <summary>An allocator.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Allocator
    {
        public IntPtr allocate;
        public IntPtr release;
        public IntPtr user;
    }

    /// <summary>Receives lines of text, valid during the call, on the thread that called the library.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Log
    {
        public IntPtr write;
        public IntPtr user;
    }

    /// <summary>The caller's scheduler, as in Box3D.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct TaskSystem
    {
        public IntPtr enqueue;
        public IntPtr finish;
        public IntPtr user;
    }

    /// <summary>Which bodies answer, and how far to look.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 32)]
    public struct QueryDesc
    {
        public uint struct_size;
        /// <summary>vox_query_flags, combined with |</summary>
        public QueryFlags flags;
        /// <summary>only bodies whose category had a bit in common with it; 0: all</summary>
        public ulong mask;
        /// <summary>not this body, e.g. the asking body; an id that the locator does not have excludes none</summary>
        public uint excluded;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>vox_locator_locate, vox_locator_find_closest and vox_locator_find_closest_to_segments: no further
        /// than this, in the caller's unit; 0: any distance</summary>
        public double max_distance;
    }

    /// <summary>Where a point is, and the weights that interpolate a field there.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 56)]
    public struct Location
    {
        public uint body;
        public uint tet;
        public LocationState state;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>Of the tetrahedron's corners, for the point or, if it is outside, for the closest point;
        /// VOX_QUERY_EXTRAPOLATE asks for the point.</summary>
        public Double4 weights;
        /// <summary>to the closest point, in the caller's unit; 0 inside</summary>
        public double distance;
    }

    /// <summary>A tetrahedron that contains a point.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 48)]
    public struct PointHit
    {
        /// <summary>index of the point</summary>
        public uint point;
        public uint body;
        public uint tet;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>of the tetrahedron's corners, in [0, 1], as in vox_location</summary>
        public Double4 weights;
    }

    /// <summary>A point of a surface.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 112)]
    public struct ClosestHit
    {
        /// <summary>VOX_NULL_BODY: no surface is within max_distance; all other fields but `inside` are 0</summary>
        public uint body;
        public uint tet;
        public uint facet;
        /// <summary>how many bodies contain the point; exact</summary>
        public uint inside;
        /// <summary>the vertices of the facet, in the order of its corners</summary>
        public Uint3 face;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>of these vertices, for the closest point, in [0, 1]</summary>
        public Double3 weights;
        /// <summary>of the closest point</summary>
        public Double3 position;
        /// <summary>A unit vector out of the facet's tetrahedron or, if that is flat, to the side away from the
        /// point.</summary>
        public Double3 normal;
        /// <summary>from the point to `position`; negative if the body contains the point, which is exact</summary>
        public double distance;
    }

    /// <summary>A tetrahedron whose bounding box meets a box.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 12)]
    public struct BoxHit
    {
        /// <summary>index of the box</summary>
        public uint box;
        public uint body;
        public uint tet;
    }

    /// <summary>A facet of a surface that a ray meets; see vox_closest_hit.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 64)]
    public struct RayHit
    {
        /// <summary>index of the ray</summary>
        public uint ray;
        public uint body;
        public uint tet;
        public uint facet;
        public Side side;
        /// <summary>the vertices of the facet, in the order of its corners</summary>
        public Uint3 face;
        public double t;
        /// <summary>of these vertices, in [0, 1]</summary>
        public Double3 weights;
    }

    /// <summary>The part of a segment that lies in one tetrahedron.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 40)]
    public struct TrackPiece
    {
        /// <summary>index of the segment</summary>
        public uint segment;
        public uint body;
        public uint tet;
        /// <summary>where the segment enters the tetrahedron, the lowest of several; VOX_NONE if the piece begins
        /// elsewhere</summary>
        public uint facet_in;
        /// <summary>where it leaves; VOX_NONE if the piece ends elsewhere</summary>
        public uint facet_out;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>the doubles nearest to the true ones</summary>
        public double t_in;
        public double t_out;
    }

    /// <summary>A tetrahedron that a triangle meets, and the edges of it that the triangle cuts.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 72)]
    public struct TriangleHit
    {
        /// <summary>index of the triangle</summary>
        public uint triangle;
        public uint body;
        public uint tet;
        /// <summary>bit k: the triangle meets edge k, an end of it included</summary>
        public uint edges;
        /// <summary>when the triangle first meets the tetrahedron; 0 if it does at first.</summary>
        public double t;
        /// <summary>where it first meets edge k, from 0 at the end with the lower vertex index to 1: the same for all
        /// tetrahedra that share the edge; 0 for edges that it does not meet</summary>
        public Double6 s;
    }

    /// <summary>A point of a cost curve.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 16)]
    public struct CostSample
    {
        public double cell_size;
        public double cost;
    }

    /// <summary>One kind of work: how often it is done at the suggested cell size, and what that costs.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CostTerm
    {
        /// <summary>static text, e.g. "visit a cell"</summary>
        public IntPtr name;
        public double count;
        public double cost;
    }

    /// <summary>The cell size that a rule of thumb gives, and the predicted cost there.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CellSizeRule
    {
        /// <summary>static text, e.g. "mean edge (Teschner et al. 2003)"</summary>
        public IntPtr name;
        /// <summary>0: the rule does not apply</summary>
        public double cell_size;
        /// <summary>0: not known</summary>
        public double cost;
    }

    /// <summary>A run at one cell size, and how long it took.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 16)]
    public struct Timing
    {
        /// <summary>&gt; 0</summary>
        public double cell_size;
        /// <summary>1e-30 to 1e30; in a result infinity if the run was impossible</summary>
        public double seconds;
    }

    /// <summary>How many nanoseconds a foreign grid takes for each kind of work, &gt;= 0.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 56)]
    public struct ForeignWeights
    {
        /// <summary>for a run, whatever the cell size</summary>
        public double run;
        /// <summary>to store a primitive in a cell</summary>
        public double store;
        /// <summary>to visit a cell in a query</summary>
        public double visit;
        /// <summary>extra, to visit a cell that is not empty</summary>
        public double found;
        /// <summary>to read a primitive in a visited cell</summary>
        public double read;
        /// <summary>to create and drop a cell that is not empty</summary>
        public double occupied;
        /// <summary>to clear a cell of a dense grid</summary>
        public double cell;
    }

    /// <summary>A cell size and the reasons for it.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CellSizeResult
    {
        public uint struct_size;
        /// <summary>vox_cell_size_warnings</summary>
        public CellSizeWarnings warnings;
        public double cell_size;
        /// <summary>the range around cell_size where the cost is at most (1 + zone_loss) times the least</summary>
        public double zone_min;
        public double zone_max;
        /// <summary>predicted at cell_size</summary>
        public double cost;
        /// <summary>the smallest that gives right answers, or fits the byte budget; 0: any</summary>
        public double min_cell_size;
        /// <summary>edge of the world divided by cell_size, as the paper counts</summary>
        public double cells_per_axis;
        /// <summary>of fit and tune: root mean square of (fitted time / measured time - 1)</summary>
        public double fit_error;
        /// <summary>of tune: how much longer a run may take than at the best cell size; 0.03 means 3 %</summary>
        public double expected_loss;
        public uint curve_count;
        public uint term_count;
        public uint rule_count;
        public uint timing_count;
        /// <summary>ascending, evenly spaced in the logarithm of the cell size</summary>
        public CostSample64 curve;
        /// <summary>their costs add up to `cost`</summary>
        public CostTerm12 terms;
        public CellSizeRule8 rules;
        /// <summary>of tune: the runs, in order</summary>
        public Timing32 timings;
        /// <summary>of foreign grids: those used, or those found by fit and tune</summary>
        public ForeignWeights weights;
        /// <summary>the warnings in words; "" if there are none</summary>
        public Byte256 note;
    }

    /// <summary>How many nanoseconds each kind of work takes on a machine, for the models REFERENCE and FAST.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 200)]
    public struct CostWeights
    {
        public uint struct_size;
        /// <summary>1 if vox_cost_calibrate filled it</summary>
        public uint measured;
        /// <summary>in the library's own order; 0: the value shipped with the library</summary>
        public Double24 ns;
    }

    /// <summary>The paper's engine (Sect. 3), for vox_grid_desc.reference.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ReferenceDesc
    {
        public uint struct_size;
        /// <summary>vox_reference_flags, combined with |</summary>
        public ReferenceFlags flags;
        /// <summary>raised to the next prime; 0: twice the number of vertices</summary>
        public ulong hash_table_size;
        /// <summary>DENSE: the box that has cells.</summary>
        public Double3 world_min;
        /// <summary>box of all positions, in every step</summary>
        public Double3 world_max;
        /// <summary>copied; null: those shipped with the library</summary>
        public CostWeights* weights;
    }

    /// <summary>How to suggest a cell size; all 0 by default.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CellSizeDesc
    {
        public uint struct_size;
        public CostModel model;
        /// <summary>REFERENCE: vox_reference_flags, combined with |</summary>
        public uint reference_flags;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>0: 0.05</summary>
        public double zone_loss;
        /// <summary>PAPER: the share of tetrahedra without a contact, in (0, 1); 0: 0.99</summary>
        public double p_nc;
        /// <summary>PAPER: r, the cost of a particle test divided by the cost of a cell visit; 0: 5</summary>
        public double cost_ratio;
        /// <summary>for cells_per_axis; 0: the longest side of the box of all vertices</summary>
        public double world_edge;
        /// <summary>REFERENCE with DENSE cells: most bytes that these may take; 0: no limit</summary>
        public ulong byte_budget;
        /// <summary>REFERENCE and FAST; null: those shipped with the library</summary>
        public CostWeights* weights;
        /// <summary>null: the C++ runtime's heap</summary>
        public Allocator* allocator;
    }

    /// <summary>Sizes in meshes, as in the paper's tables.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 168)]
    public struct Geometry
    {
        public uint struct_size;
        public uint reserved;
        public ulong vertices;
        public ulong tets;
        /// <summary>unique</summary>
        public ulong edges;
        /// <summary>unique</summary>
        public ulong facets;
        /// <summary>of exactly one tetrahedron</summary>
        public ulong boundary_facets;
        /// <summary>of zero volume; exact</summary>
        public ulong degenerate_tets;
        public double mean_edge;
        /// <summary>over tetrahedra</summary>
        public double mean_longest_edge;
        /// <summary>over tetrahedra, the longest side of the box</summary>
        public double mean_box_side;
        public double median_box_side;
        /// <summary>over unique facets</summary>
        public double mean_facet_area;
        /// <summary>over the four facets of each tetrahedron</summary>
        public double mean_tet_facet_area;
        public double mean_boundary_facet_area;
        public double mean_volume;
        public Double3 bounds_min;
        public Double3 bounds_max;
    }

    /// <summary>An array of primitives.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Primitives
    {
        public uint struct_size;
        public PrimitiveType type;
        /// <summary>of vertices</summary>
        public Positions positions;
        /// <summary>the vertices of each primitive; null: 0, 1, 2, ... in order</summary>
        public uint* indices;
        /// <summary>from one primitive to the next; 0: packed</summary>
        public ulong index_byte_stride;
        /// <summary>number of primitives</summary>
        public ulong count;
        /// <summary>one number &gt;= 0 for each primitive; null: 0</summary>
        public IntPtr radii;
        /// <summary>0: packed</summary>
        public ulong radius_byte_stride;
        public Format radius_format;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>added to all radii</summary>
        public double radius;
    }

    /// <summary>A uniform grid of another library.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ForeignGrid
    {
        public uint struct_size;
        public KnownGrid known;
        public CellsStored cells_stored;
        public CellsQueried cells_queried;
        public CellsKept cells_kept;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>the primitives in cells; must be set</summary>
        public Primitives* stored;
        /// <summary>the queries; null: the stored primitives query each other.</summary>
        public Primitives* querying;
        /// <summary>grows the boxes of queries on all sides</summary>
        public double radius;
        /// <summary>the smallest that gives right answers; 0: any, or with 27 what the boxes demand</summary>
        public double min_cell_size;
        /// <summary>0: 0.05</summary>
        public double zone_loss;
        /// <summary>all 0: as for the known grid</summary>
        public ForeignWeights weights;
        /// <summary>null: the C++ runtime's heap</summary>
        public Allocator* allocator;
    }

    /// <summary>How often a run does what, on average over all positions of the lattice.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 48)]
    public struct ForeignCounts
    {
        /// <summary>primitives stored in a cell</summary>
        public double stored;
        /// <summary>cells visited; with PAIRS, cells that store something</summary>
        public double visits;
        /// <summary>visited cells that store nothing</summary>
        public double empty;
        /// <summary>primitives read in visited cells; with PAIRS, pairs within a cell</summary>
        public double reads;
        /// <summary>cells that store something</summary>
        public double occupied;
        /// <summary>cells in the box of the stored primitives</summary>
        public double cells;
    }

    /// <summary>How to tune; all 0 by default.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 40)]
    public struct TuneDesc
    {
        public uint struct_size;
        /// <summary>3 to VOX_TIMING_CAPACITY; 0: 7</summary>
        public uint max_runs;
        /// <summary>the range of cell sizes to try; both 0: from 1/8 to 8 times the first</summary>
        public double min;
        public double max;
        /// <summary>the cell size to begin with; 0: as vox_foreign_grid_suggest says</summary>
        public double first;
        /// <summary>stop when the expected loss is below this; 0: 0.02</summary>
        public double wanted_loss;
    }

    /// <summary>The topology of a surface, which is copied.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct SurfaceDesc
    {
        public uint struct_size;
        /// <summary>as in vox_grid_desc</summary>
        public uint worker_count;
        /// <summary>at least 1</summary>
        public ulong vertex_count;
        public ulong edge_count;
        public ulong face_count;
        /// <summary>2 * edge_count vertex indices.</summary>
        public uint* edges;
        /// <summary>3 * face_count vertex indices</summary>
        public uint* faces;
        /// <summary>Patches say what may meet.</summary>
        public uint* patches;
        /// <summary>patch_count numbers; null: 1 each</summary>
        public ulong* patch_categories;
        /// <summary>patch_count numbers; null: all bits</summary>
        public ulong* patch_masks;
        public ulong patch_count;
        /// <summary>edge length of a cell; 0: the library chooses it for every motion.</summary>
        public double cell_size;
        /// <summary>most bytes the surface may hold, lists included; 0: 4 GiB; UINT64_MAX: no limit</summary>
        public ulong byte_budget;
        /// <summary>copied; null: the C++ runtime's heap</summary>
        public Allocator* allocator;
        /// <summary>copied; null: the built-in scheduler</summary>
        public TaskSystem* tasks;
    }

    /// <summary>The vertices of edges or faces.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct FeatureView
    {
        /// <summary>2 * count indices for edges, 3 * count for faces</summary>
        public uint* vertices;
        /// <summary>number of edges or faces</summary>
        public ulong count;
    }

    /// <summary>Positions of all vertices, or a motion from one set of positions to another.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Motion
    {
        public uint struct_size;
        /// <summary>vox_motion_flags, combined with |</summary>
        public MotionFlags flags;
        /// <summary>at time 0</summary>
        public Positions from;
        /// <summary>at time 1, in the same format; none: everything stands still</summary>
        public Positions to;
        /// <summary>grows the box of a vertex on all sides, rounded outward to the next number of the format, by one
        /// number also where it is 0; may be infinite</summary>
        public double radius;
    }

    /// <summary>Lists of partners.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct PartnerLists
    {
        /// <summary>count + 1 numbers</summary>
        public ulong* offsets;
        public uint* partners;
        public ulong first;
        /// <summary>features with a list; fewer than the range has if the byte budget is short</summary>
        public ulong count;
    }

    /// <summary>An edge and a face that have a point in common.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 80)]
    public struct Crossing
    {
        public uint edge;
        public uint face;
        public CrossingKind kind;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>of a common point; they add up to 1, as do the next</summary>
        public Double2 edge_weights;
        public Double3 face_weights;
        public Double3 position;
    }

    /// <summary>Crossings, sorted by (edge, face).</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CrossingView
    {
        public Crossing* data;
        public ulong count;
    }

    /// <summary>Two features and their closest points.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 112)]
    public struct Proximity
    {
        public uint a;
        public uint b;
        public double distance;
        /// <summary>of the closest point of a: one for each of its vertices, then 0</summary>
        public Double3 weights_a;
        public Double3 weights_b;
        public Double3 point_a;
        public Double3 point_b;
    }

    /// <summary>Proximities, sorted by (a, b).</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ProximityView
    {
        public Proximity* data;
        public ulong count;
    }

    /// <summary>How times of impact are computed; all 0 by default.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 24)]
    public struct ImpactDesc
    {
        public uint struct_size;
        /// <summary>for a pair, after which its time is too early; 0: 10000</summary>
        public uint max_iterations;
        /// <summary>two features meet when they come this close</summary>
        public double distance;
        /// <summary>part of their first gap that may be left at the reported time, below 1; 0: 0.1.</summary>
        public double slack;
    }

    /// <summary>How much of the motion is free of impacts, and which pair ends it.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 40)]
    public struct SafeStep
    {
        /// <summary>nothing meets before this time; 1: nothing meets</summary>
        public double step;
        /// <summary>number of pairs examined</summary>
        public ulong pairs;
        /// <summary>the first pair to meet, if step is below 1: FACE and VERTEX, or EDGE and EDGE</summary>
        public Feature kind_a;
        public Feature kind_b;
        public uint a;
        public uint b;
        /// <summary>1 if its time is early because of max_iterations, else 0</summary>
        public uint unfinished;
        /// <summary>0</summary>
        public uint reserved;
    }

    /// <summary>Two features that may meet, and the earliest time.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 16)]
    public struct Impact
    {
        public uint a;
        public uint b;
        public double time;
    }

    /// <summary>Impacts, sorted by (a, b).</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ImpactView
    {
        public Impact* data;
        public ulong count;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct IoLoadDesc
    {
        public uint struct_size;
        public IoFormat format;
        /// <summary>which mesh of a scene file to take, from 1; 0: all, joined</summary>
        public uint mesh;
        /// <summary>vox_io_load_flags</summary>
        public IoLoadFlags flags;
        /// <summary>Where the arrays of the mesh live until vox_io_mesh_destroy.</summary>
        public Allocator* allocator;
        /// <summary>Called now and then, on the calling thread, with the fraction of the work done, ascending from 0 to
        /// 1: about half of it is reading, the rest the report.</summary>
        public IntPtr progress;
        public IntPtr progress_user;
    }

    /// <summary>One file in memory.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct IoSource
    {
        public IntPtr name;
        public IntPtr data;
        public UIntPtr size;
    }

    /// <summary>Arrays of a mesh; they live until vox_io_mesh_destroy.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct IoMeshView
    {
        public double* positions;
        public ulong vertex_count;
        /// <summary>corners in the file's order</summary>
        public uint* tets;
        public ulong tet_count;
        /// <summary>as in the file</summary>
        public uint* triangles;
        public ulong triangle_count;
        /// <summary>A number for each tet, where the file has some that are not 0; else null.</summary>
        public int* tet_regions;
        /// <summary>For each vertex its number in the file, counted from 0 in the file's order, ascending; null if
        /// vertices were not left out.</summary>
        public uint* file_vertices;
        /// <summary>For each tet the number of its cell in the file, counted from 0 in the file's order through cells
        /// of every kind, ascending; null if tet t is cell t.</summary>
        public uint* tet_cells;
    }

    /// <summary>What was read, what was left out, and what is odd about the mesh.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 240)]
    public struct IoReport
    {
        public uint struct_size;
        /// <summary>AUTO for a mesh that was not read from a file</summary>
        public IoFormat format;
        public ulong vertices;
        public ulong tets;
        public ulong triangles;
        /// <summary>elements of the file that are neither tet nor triangle</summary>
        public ulong skipped_elements;
        /// <summary>tets of ten or more nodes, of which only the corners were used</summary>
        public ulong second_order_tets;
        /// <summary>of negative volume, decided exactly</summary>
        public ulong inverted_tets;
        /// <summary>of exactly zero volume</summary>
        public ulong degenerate_tets;
        /// <summary>six times the volume below 1e-9 times the longest edge cubed, but not zero</summary>
        public ulong nearly_flat_tets;
        /// <summary>the same four vertices as an earlier tet</summary>
        public ulong duplicate_tets;
        /// <summary>triangles that name a vertex twice</summary>
        public ulong degenerate_triangles;
        /// <summary>vertices at the position of an earlier one</summary>
        public ulong duplicate_vertices;
        /// <summary>in no tet and no triangle</summary>
        public ulong unused_vertices;
        /// <summary>facets of exactly one tet; for a surface: its triangles</summary>
        public ulong boundary_facets;
        /// <summary>facets of more than two tets; for a surface: edges of more than two triangles</summary>
        public ulong non_manifold_facets;
        /// <summary>for a surface: edges of exactly one triangle; 0 when it is closed</summary>
        public ulong open_edges;
        /// <summary>for a surface: edges that two triangles run through in the same direction</summary>
        public ulong misoriented_edges;
        /// <summary>parts connected by shared vertices; unused vertices are not counted</summary>
        public ulong components;
        /// <summary>sum of the tets' volumes, inverted ones counted as positive; for a closed surface the enclosed
        /// volume, negative if it is inside out; otherwise 0</summary>
        public double volume;
        /// <summary>bounding box of the vertices in use, or of all vertices if none is in use</summary>
        public Double3 bounds_min;
        public Double3 bounds_max;
        /// <summary>length of the file's unit; 0 if the file does not state it</summary>
        public double unit_in_metres;
        /// <summary>vertices of the file that belong to no tet and are not in the mesh</summary>
        public ulong left_out_vertices;
        /// <summary>triangles of the file that name one of them and are not in the mesh</summary>
        public ulong left_out_triangles;
        /// <summary>hexahedra, wedges and pyramids of the file that were split into tets</summary>
        public ulong split_cells;
        /// <summary>tets of ten or more nodes whose corners lie in one plane, exactly</summary>
        public ulong left_out_tets;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct IoTetrahedralizeDesc
    {
        public uint struct_size;
        public IoSolidKind kind;
        /// <summary>edge of a lattice cube; 0: a fiftieth of the surface's longest side</summary>
        public double cell;
        /// <summary>more tets fail with LIMIT; 0: 100000000</summary>
        public ulong max_tets;
        /// <summary>STUFFED: largest Hausdorff distance to the surface, as measured by vox_io_mesh_measure.</summary>
        public double max_distance;
        /// <summary>STUFFED: how many times cells away from the boundary may be merged, eight into one. 0: all tets
        /// have the same size.</summary>
        public uint coarsen;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>Called now and then, on the calling thread, with the fraction of the work done, ascending from 0 to
        /// 1.</summary>
        public IntPtr progress;
        public IntPtr progress_user;
        /// <summary>as vox_io_load_desc.allocator</summary>
        public Allocator* allocator;
    }

    /// <summary>How good a tet mesh is, and how close its boundary is to a surface.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 88)]
    public struct IoQuality
    {
        public uint struct_size;
        public uint reserved;
        public ulong vertices;
        public ulong tets;
        public ulong boundary_facets;
        /// <summary>smallest and largest angle between two facets of a tet, in degrees; 0 without tets</summary>
        public double min_dihedral;
        public double max_dihedral;
        /// <summary>sum of the signed tet volumes</summary>
        public double volume;
        /// <summary>volume enclosed by the surface, signed by its orientation; 0 without a surface</summary>
        public double surface_volume;
        /// <summary>Largest distance from sample points on the mesh's boundary to the surface, and the
        /// reverse.</summary>
        public double mesh_to_surface;
        public double surface_to_mesh;
        /// <summary>the larger of the two</summary>
        public double hausdorff;
    }

    /// <summary>Numbers attached to the vertices or cells, e.g. contacts or penetration depths.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct IoPointData
    {
        /// <summary>not empty, without control characters and double quotes</summary>
        public IntPtr name;
        /// <summary>Finite numbers, `components` for each vertex, or for each cell.</summary>
        public double* values;
        /// <summary>1 (scalars), 3 (vectors) or 9 (tensors)</summary>
        public uint components;
        /// <summary>0</summary>
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct IoWriteDesc
    {
        public uint struct_size;
        public IoWriteFormat format;
        /// <summary>0: text, from which the same doubles are read back; 1: binary, in this machine's byte
        /// order</summary>
        public uint binary;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>read during the call</summary>
        public IoPointData* point_data;
        public ulong point_data_count;
        /// <summary>with values for each cell</summary>
        public IoPointData* cell_data;
        public ulong cell_data_count;
    }

    /// <summary>Receives `size` bytes of a file, in order, on the thread that writes.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct IoSink
    {
        public IntPtr write;
        public IntPtr user;
    }

    /// <summary>Settings of a simulation.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct SimDesc
    {
        public uint struct_size;
        /// <summary>of a step, 1 to 10000; 10</summary>
        public uint substeps;
        /// <summary>substeps from one detection of contacts to the next, or 0 for no detection; 1</summary>
        public uint detect_every;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>0, 0, -9.81</summary>
        public Double3 gravity;
        /// <summary>longer steps are shortened to this; 1/30</summary>
        public double max_time_step;
        /// <summary>particles stay where dot(floor_normal, x) &gt;= floor_offset; all 0: no floor; 0, 0, 1</summary>
        public Double3 floor_normal;
        /// <summary>0</summary>
        public double floor_offset;
        /// <summary>Coulomb's coefficient; 0.5</summary>
        public double friction;
        /// <summary>inverse stiffness of contacts, or 0 for the stiffest that a substep can handle; 0</summary>
        public double contact_compliance;
        /// <summary>greatest speed at which older overlap is undone; 1</summary>
        public double max_push_speed;
        /// <summary>depth that is tolerated, or -1 for a hundredth of the mean edge; -1</summary>
        public double contact_slop;
        /// <summary>settings of the grid inside; null: the defaults</summary>
        public GridDesc* grid;
        public Log* log;
        /// <summary>of the simulation and, unless `grid` has one, its grid</summary>
        public Allocator* allocator;
    }

    /// <summary>A soft body, which is copied.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct SimBodyDesc
    {
        public uint struct_size;
        /// <summary>vox_sim_body_flags, combined with |</summary>
        public SimBodyFlags flags;
        /// <summary>3 * vertex_count</summary>
        public double* positions;
        /// <summary>3 * vertex_count: the undeformed shape; null: positions</summary>
        public double* rest_positions;
        /// <summary>3 * vertex_count; null: 0</summary>
        public double* velocities;
        /// <summary>4 * tet_count vertex indices, in either winding</summary>
        public uint* tets;
        public ulong vertex_count;
        /// <summary>at least 1</summary>
        public ulong tet_count;
        /// <summary>mass over rest volume; 1000</summary>
        public double density;
        /// <summary>resistance to stretching; 1e6</summary>
        public double youngs_modulus;
        /// <summary>resistance to changes of volume, beyond what the edges have; 1e6</summary>
        public double bulk_modulus;
        /// <summary>a time: damping of the edges over their stiffness; 0.01</summary>
        public double damping;
        /// <summary>of the body in the grid</summary>
        public ulong user_data;
    }

    /// <summary>The arrays of a body.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct SimBodyView
    {
        /// <summary>3 * vertex_count</summary>
        public double* positions;
        /// <summary>3 * vertex_count</summary>
        public double* velocities;
        /// <summary>vertex_count</summary>
        public double* masses;
        /// <summary>3 * vertex_count: positions rounded to float; the grid borrows them, or `positions` once floats
        /// round by more than 2^-14 of a mean edge, far from the origin</summary>
        public float* grid_positions;
        /// <summary>4 * tet_count</summary>
        public uint* tets;
        public ulong vertex_count;
        public ulong tet_count;
    }

    /// <summary>Energy and motion.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 88)]
    public struct SimEnergy
    {
        public double kinetic;
        /// <summary>in gravity, 0 at the origin</summary>
        public double potential;
        public double elastic;
        public double mass;
        public Double3 momentum;
        /// <summary>of mass</summary>
        public Double3 centre;
        /// <summary>of the fastest particle</summary>
        public double max_speed;
    }

    /// <summary>A body whose intersections are to go: tetrahedra, or a surface without any.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ResolveBody
    {
        public uint struct_size;
        /// <summary>vox_resolve_flags, combined with |</summary>
        public ResolveFlags flags;
        /// <summary>3 * vertex_count; vox_resolve replaces them</summary>
        public double* positions;
        public ulong vertex_count;
        /// <summary>4 * tet_count vertex indices, in either winding</summary>
        public uint* tets;
        public ulong tet_count;
        /// <summary>3 * face_count vertex indices; a body with tetrahedra has none</summary>
        public uint* faces;
        public ulong face_count;
        /// <summary>Results, which vox_resolve sets:</summary>
        public ulong moved_vertices;
        /// <summary>of a vertex</summary>
        public double largest_move;
        /// <summary>of the tetrahedra or in a closed surface; else 0</summary>
        public double volume_before;
        /// <summary>afterwards</summary>
        public double volume;
        /// <summary>whose signed volume has another sign than before</summary>
        public ulong inverted_tets;
    }

    /// <summary>A place where something is left: an edge that meets a face, or two features closer than the
    /// gap.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 40)]
    public struct ResolvePlace
    {
        /// <summary>indices into the bodies, which may be the same</summary>
        public uint body_a;
        public uint body_b;
        /// <summary>0: they meet</summary>
        public double distance;
        public Double3 position;
    }

    /// <summary>Settings; all 0 by default.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ResolveDesc
    {
        public uint struct_size;
        /// <summary>as in vox_grid_desc</summary>
        public uint worker_count;
        /// <summary>0: 400</summary>
        public uint max_iterations;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>least distance of features without a common vertex; 0: they only do not meet</summary>
        public double gap;
        /// <summary>no vertex moves further than this; 0: no limit</summary>
        public double max_move;
        /// <summary>receives the first place_capacity places where something is left</summary>
        public ResolvePlace* places;
        public ulong place_capacity;
        public Allocator* allocator;
    }

    /// <summary>What was done and what is left.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 80)]
    public struct ResolveReport
    {
        public uint struct_size;
        /// <summary>1: nothing is left; else 0</summary>
        public uint resolved;
        /// <summary>edges that met a face before</summary>
        public ulong first_crossings;
        /// <summary>edges that still do</summary>
        public ulong crossings;
        /// <summary>vertices and edges that still are in a body</summary>
        public ulong inside_vertices;
        /// <summary>pairs closer than the gap; 0 if there are crossings</summary>
        public ulong close_pairs;
        /// <summary>greatest depth in a body before</summary>
        public double first_depth;
        /// <summary>of close pairs; 0 if there are crossings; else the gap</summary>
        public double least_distance;
        public double largest_move;
        public ulong iterations;
        /// <summary>of crossings and close pairs together</summary>
        public ulong place_count;
    }

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate void Task(ulong begin, ulong end, uint worker, IntPtr context);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate double CostFunction(double cell_size, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate double ForeignRun(double cell_size, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal unsafe delegate void ShapeDescField(double* points, ulong count, double* distances, double* gradients, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate IntPtr AllocatorAllocate(UIntPtr size, UIntPtr alignment, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate void AllocatorRelease(IntPtr memory, UIntPtr size, UIntPtr alignment, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate void LogWrite(LogLevel level, IntPtr text, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate IntPtr TaskSystemEnqueue(IntPtr task, ulong item_count, ulong min_range, IntPtr context, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate void TaskSystemFinish(IntPtr handle, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate int IoLoadDescProgress(double fraction, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate int IoTetrahedralizeDescProgress(double fraction, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate int IoSinkWrite(IntPtr data, UIntPtr size, IntPtr user);

    internal static unsafe class Native
    {
        /// <summary>A program runs with any library of the ABI version that it was built with (docs/abi.md).</summary>
        internal const uint VOX_ABI_VERSION = 1;
        /// <summary>as an index: none</summary>
        internal const uint VOX_NONE = 4294967295;
        /// <summary>as a worker_count: one worker per core</summary>
        internal const uint VOX_ALL_CORES = 4294967295;
        /// <summary>in a grid at one time</summary>
        internal const uint VOX_MAX_BODIES = 1048576;
        /// <summary>in a grid</summary>
        internal const uint VOX_MAX_VERTICES = 2147483647;
        /// <summary>in a grid</summary>
        internal const uint VOX_MAX_TETS = 2147483647;
        /// <summary>in a mesh whose surface is needed: constraints, edges, margin, queries</summary>
        internal const uint VOX_MAX_SURFACE_TETS = 357913941;
        /// <summary>in a step</summary>
        internal const uint VOX_MAX_CONTACTS = 4294967295;
        /// <summary>of a grid</summary>
        internal const uint VOX_MAX_WORKERS = 256;
        /// <summary>vox_grid_desc.max_constraints_per_pair</summary>
        internal const uint VOX_MAX_CONSTRAINTS_PER_PAIR = 256;
        /// <summary>names no body</summary>
        internal const uint VOX_NULL_BODY = 0;
        /// <summary>vox_filter.self_rings</summary>
        internal const uint VOX_MAX_RINGS = 8;
        /// <summary>most vertices of a constraint</summary>
        internal const uint VOX_STENCIL_CAPACITY = 5;
        /// <summary>in one call</summary>
        internal const uint VOX_MAX_TASKS = 64;
        /// <summary>most samples of a curve</summary>
        internal const uint VOX_CURVE_CAPACITY = 64;
        /// <summary>most terms of a cost</summary>
        internal const uint VOX_TERM_CAPACITY = 12;
        /// <summary>most rules that are compared</summary>
        internal const uint VOX_RULE_CAPACITY = 8;
        /// <summary>most runs of vox_foreign_grid_tune</summary>
        internal const uint VOX_TIMING_CAPACITY = 32;
        /// <summary>bytes of a note, its zero included; it is cut to that</summary>
        internal const uint VOX_NOTE_CAPACITY = 256;
        /// <summary>numbers in vox_cost_weights</summary>
        internal const uint VOX_COST_WEIGHT_CAPACITY = 24;
        /// <summary>vertices, edges or faces of a surface, each</summary>
        internal const uint VOX_MAX_FEATURES = 2147483647;
        /// <summary>patches of a surface</summary>
        internal const uint VOX_MAX_PATCHES = 65536;

#if (UNITY_IOS || UNITY_WEBGL) && !UNITY_EDITOR
        const string vox = "__Internal";
        const string vox_io = "__Internal";
        const string vox_sim = "__Internal";
#else
        const string vox = "vox";
        const string vox_io = "vox_io";
        const string vox_sim = "vox_sim";
#endif

        /// <summary>Why the last failing call on this thread failed, e.g. "tet 17 names vertex 900 of 812"; "" if no
        /// call has failed.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern IntPtr vox_last_error();

        /// <summary>Name of a result, e.g. "VOX_ERROR_BUDGET".</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern IntPtr vox_result_string(Result result);

        /// <summary>Creates a grid.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_create(GridDesc* desc, IntPtr* out_grid);

        /// <summary>Destroys a grid, its bodies and results.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern void vox_grid_destroy(IntPtr grid);

        /// <summary>Adds a mesh, which takes part from the next step on.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_insert(IntPtr grid, MeshDesc* desc, uint* out_body);

        /// <summary>Removes a body.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_remove(IntPtr grid, uint body);

        /// <summary>Makes a mesh borrow another array of positions, one for each vertex, in place of its present
        /// array.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_bind_positions(IntPtr grid, uint body, Positions* positions);

        /// <summary>Finds all contacts of the bodies as they are now, and whatever the flags ask for.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_step(IntPtr grid);

        /// <summary>Steps many different grids, several at a time: for many small scenes. worker_count and `tasks` are
        /// as in vox_grid_desc; each grid is stepped by one thread and should have a worker_count of 0
        /// itself.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grids_step(IntPtr* grids, ulong count, uint worker_count, TaskSystem* tasks,
            Result* results);

        /// <summary>Gets the contacts of the last step.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_contacts(IntPtr grid, ContactView* out_view);

        /// <summary>Gets a hash of the contacts and their order, which is the same on every machine.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_hash(IntPtr grid, ulong* out_hash);

        /// <summary>Gets the pairs of the last step.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_pairs(IntPtr grid, PairView* out_view);

        /// <summary>Finds the constraints of the last step.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_find_constraints(IntPtr grid, ConstraintDesc* desc);

        /// <summary>Gets the constraints that were found last.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_constraints(IntPtr grid, ConstraintView* out_view);

        /// <summary>Places a body.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_set_transform(IntPtr grid, uint body, double* matrix);

        /// <summary>Disables a body (0), or enables it again (1).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_set_enabled(IntPtr grid, uint body, uint enabled);

        /// <summary>Sets what a body collides with from the next step on.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_set_filter(IntPtr grid, uint body, Filter* filter);

        /// <summary>Keeps two bodies from colliding, whatever their filters say (0), or lets their filters decide again
        /// (1).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_set_pair_enabled(IntPtr grid, uint body_a, uint body_b, uint enabled);

        /// <summary>Makes the next step treat a body as if it had moved: for measurements.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_mark_moved(IntPtr grid, uint body);

        /// <summary>Gives a mesh a packed array of its own, in its format, which the caller may write to between
        /// steps.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_map_positions(IntPtr grid, uint body, IntPtr* out_positions);

        /// <summary>Makes a mesh borrow the positions that its vertices had before.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_bind_previous_positions(IntPtr grid, uint body, Positions* positions);

        /// <summary>Gets a body's state.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_get_info(IntPtr grid, uint body, BodyInfo* out_info);

        /// <summary>Gets the user_data that a body was inserted with.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_get_user_data(IntPtr grid, uint body, ulong* out_user_data);

        /// <summary>Returns 1 if `body` names a body of the grid, else 0; gives 0 for a null grid.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern uint vox_body_is_valid(IntPtr grid, uint body);

        /// <summary>Gets the first `capacity` bodies of the grid in ascending order, disabled ones included; `bodies`
        /// may be null if it is 0.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_bodies(IntPtr grid, uint* bodies, ulong capacity, ulong* out_count);

        /// <summary>Adds a shape, which takes part from the next step on.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_shape_insert(IntPtr grid, ShapeDesc* desc, uint* out_body);

        /// <summary>Says where a shape was before.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_shape_set_previous_transform(IntPtr grid, uint body, double* matrix);

        /// <summary>Removes all bodies and results, and keeps the settings.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_clear(IntPtr grid);

        /// <summary>Allocates memory for this many bodies and contacts in advance, besides what the bodies themselves
        /// need.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_reserve(IntPtr grid, uint body_count, ulong contact_count);

        /// <summary>Makes now what steps make of a mesh once, when they first need it: topology, rings, tiles of its
        /// surface and the tree over that, as far as the flags, the margin and its filter ask for them.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_prepare(IntPtr grid);

        /// <summary>Sets vox_grid_desc.cell_size for the following steps.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_set_cell_size(IntPtr grid, double cell_size);

        /// <summary>Sets vox_grid_desc.worker_count for the following steps.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_set_worker_count(IntPtr grid, uint worker_count);

        /// <summary>Sets all vox_grid_desc.flags for the following steps.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_set_flags(IntPtr grid, GridFlags flags);

        /// <summary>Sets the margin for the following steps: vertices outside another body, but no further than this
        /// from its surface, have PROXIMITY constraints, and the two bodies are a pair. 0, the default: none, at no
        /// cost.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_set_margin(IntPtr grid, double margin);

        /// <summary>Gets a grid's state.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_info(IntPtr grid, GridInfo* out_info);

        /// <summary>Gets counts and times of the last step, stage by stage (docs/engine.md lists them).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_counters(IntPtr grid, CounterView* out_view);

        /// <summary>Gets the body that made the last step fail, with index 0; or else the bodies that it left out, with
        /// indices from 0 on.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_failure(IntPtr grid, uint index, Failure* out_failure);

        /// <summary>Replaces vertices, tetrahedra and positions by what desc has.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_set_topology(IntPtr grid, uint body, MeshDesc* desc);

        /// <summary>Disables tetrahedra (0), or enables them again (1).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_set_tets_enabled(IntPtr grid, uint body, uint* tets, ulong count, uint
            enabled);

        /// <summary>Gives tetrahedron tets[i] the corners corners[4 * i] to corners[4 * i + 3].</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_replace_tets(IntPtr grid, uint body, uint* tets, ulong count, uint*
            corners);

        /// <summary>Adds `count` tetrahedra with four corners each.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_append_tets(IntPtr grid, uint body, uint* corners, ulong count, uint*
            out_first);

        /// <summary>Removes tetrahedra.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_remove_tets(IntPtr grid, uint body, uint* tets, ulong count);

        /// <summary>Adds vertices, which belong to no tetrahedron yet.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_append_vertices(IntPtr grid, uint body, VerticesDesc* desc, uint*
            out_first);

        /// <summary>Removes vertices that belong to no enabled tetrahedron.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_remove_vertices(IntPtr grid, uint body, uint* vertices, ulong count);

        /// <summary>Copies the first `capacity` tetrahedra: four corners each, and 1 if it is enabled or 0 if it is
        /// disabled or removed.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_get_tets(IntPtr grid, uint body, uint* corners, byte* enabled, ulong
            capacity, ulong* out_count);

        /// <summary>Writes a grid to `bytes`, in a format that is the same on every machine (docs/snapshot.md):
        /// settings, bodies with their ids and positions, and which pairs touch.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_save(IntPtr grid, IntPtr bytes, ulong capacity, ulong* out_size);

        /// <summary>Creates a grid from a snapshot.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_load(IntPtr bytes, ulong size, GridDesc* desc, IntPtr* out_grid);

        /// <summary>The version of the library at run time: major * 1000000 + minor * 1000 + patch.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern uint vox_version();

        /// <summary>The VOX_ABI_VERSION of the library at run time.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern uint vox_abi_version();

        /// <summary>Version, compiler, instruction sets, scheduler and options of the library, in one line.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern IntPtr vox_build_info();

        /// <summary>Sets this thread's vox_last_error() to a copy of `text`, of 1023 bytes at most, and returns
        /// `result`: for libraries that report failures in the same way.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_fail(Result result, IntPtr text);

        /// <summary>Takes a locator of the grid as it is now, and releases what *locator held before, if
        /// anything.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_update_locator(IntPtr grid, IntPtr* locator);

        /// <summary>Adds an owner, who has to release the locator as well: so one thread can still ask it while another
        /// takes the next one.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_retain(IntPtr locator);

        /// <summary>Removes an owner.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern void vox_locator_release(IntPtr locator);

        /// <summary>Gets vox_grid_info.epoch of the moment when the locator was taken.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_get_epoch(IntPtr locator, ulong* out_epoch);

        /// <summary>Gets the user_data of a body, even if it was removed since.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_get_user_data(IntPtr locator, uint body, ulong* out_user_data);

        /// <summary>Locates points: out_locations[i] is for point i, and depends on no other point.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_locate(IntPtr locator, Positions* points, QueryDesc* desc, Location*
            out_locations);

        /// <summary>Finds the tetrahedra that contain points, by the rule of vox_contact: every tetrahedron of a body
        /// that has the point in its interior or, if there is none, the lowest that has it on its boundary.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_find_point_hits(IntPtr locator, Positions* points, QueryDesc* desc,
            PointHit* hits, ulong capacity, ulong* out_count);

        /// <summary>Finds the closest point of all surfaces: out_hits[i] is for point i.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_find_closest(IntPtr locator, Positions* points, QueryDesc* desc,
            ClosestHit* out_hits);

        /// <summary>Finds the tetrahedra whose bounding box has a point in common with the closed box from min[i] to
        /// max[i], decided exactly and sorted by (box, body, tet).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_find_box_hits(IntPtr locator, Positions* min, Positions* max,
            QueryDesc* desc, BoxHit* hits, ulong capacity, ulong* out_count);

        /// <summary>Finds the facets of surfaces that rays meet, sorted by (ray, t, body, tet, facet).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_find_ray_hits(IntPtr locator, Positions* from, Positions* to,
            QueryDesc* desc, RayHit* hits, ulong capacity, ulong* out_count);

        /// <summary>Tests whether each ray meets a tetrahedron that has a volume: out_blocked[i] is 1 or 0, which is
        /// exact.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_test_rays(IntPtr locator, Positions* from, Positions* to, QueryDesc*
            desc, byte* out_blocked);

        /// <summary>Finds the tetrahedra that segments pass through, sorted by (segment, body, t_in, t_out,
        /// tet).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_find_tracks(IntPtr locator, Positions* from, Positions* to, QueryDesc*
            desc, TrackPiece* pieces, ulong capacity, ulong* out_count);

        /// <summary>Finds the closest points of segments and all surfaces, e.g. of a capsule's axis: it touches where
        /// the distance is less than its radius. out_hits[i] is for the closed segment from from[i] to to[i], as for a
        /// point: `position` is the point of the surface that is closest to the segment.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_find_closest_to_segments(IntPtr locator, Positions* from, Positions*
            to, QueryDesc* desc, ClosestHit* out_hits);

        /// <summary>Finds the tetrahedra that triangles meet, sorted by (triangle, body, t, tet): for a cut, in order
        /// along the motion.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_locator_find_triangle_hits(IntPtr locator, Positions* from, Positions* to,
            QueryDesc* desc, TriangleHit* hits, ulong capacity, ulong* out_count);

        /// <summary>Suggests the cell size with the least cost for these meshes as they are now.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_suggest_cell_size(CellSizeDesc* desc, MeshDesc* meshes, ulong mesh_count,
            CellSizeResult* @out);

        /// <summary>Suggests a cell size for the meshes of a grid.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_suggest_cell_size(IntPtr grid, CellSizeDesc* desc, CellSizeResult* @out);

        /// <summary>Measures this machine's weights with steps over a small scene, in about ten milliseconds.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_cost_calibrate(CostWeights* @out);

        /// <summary>Measures meshes, which are given as for vox_suggest_cell_size.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_measure_geometry(MeshDesc* meshes, ulong mesh_count, Geometry* @out);

        /// <summary>Finds the cell size between min and max with the least cost: a scan evenly spaced in the logarithm,
        /// then a golden-section search, in about a hundred calls. zone_loss 0 means 0.05.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_cost_minimise(IntPtr cost, IntPtr user, double min, double max, double
            zone_loss, CellSizeResult* @out);

        /// <summary>Suggests the cell size with the least cost.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_foreign_grid_suggest(ForeignGrid* grid, CellSizeResult* @out);

        /// <summary>Predicts the counts of a run at a cell size, for comparison with a program's own
        /// counters.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_foreign_grid_count(ForeignGrid* grid, double cell_size, ForeignCounts* @out);

        /// <summary>Finds weights and cell size from timings of whole runs at three or more cell sizes; 0.6, 1.2 and
        /// 2.4 mean edges will do.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_foreign_grid_fit(ForeignGrid* grid, Timing* timings, ulong count,
            CellSizeResult* @out);

        /// <summary>Finds the best cell size by running the grid a few times.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_foreign_grid_tune(ForeignGrid* grid, TuneDesc* desc, IntPtr run, IntPtr user,
            CellSizeResult* @out);

        /// <summary>Creates a surface without positions.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_create(SurfaceDesc* desc, IntPtr* out_surface);

        /// <summary>Destroys a surface.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern void vox_surface_destroy(IntPtr surface);

        /// <summary>Gets the edges or faces of a surface, in the order of their indices.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_get_features(IntPtr surface, Feature feature, FeatureView* out_view);

        /// <summary>Sets the motion that all other functions answer for.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_move(IntPtr surface, Motion* motion);

        /// <summary>Finds, for the features [first, first + count) of kind a, the features of kind b whose boxes
        /// overlap or touch theirs.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_pairs(IntPtr surface, Feature a, Feature b, ulong first, ulong
            count, PartnerLists* out_lists);

        /// <summary>Finds all edges and faces that have a point in common, but no vertex, at the end of the motion:
        /// none if the surface does not intersect itself.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_crossings(IntPtr surface, CrossingView* out_view);

        /// <summary>Finds all pairs of features of kinds a and b that are at most `distance` apart at the end of the
        /// motion.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_proximities(IntPtr surface, Feature a, Feature b, double
            distance, ProximityView* out_view);

        /// <summary>Finds a distance for each vertex, at most max_distance, such that nothing new touches while no
        /// vertex moves further than its distance from the end of the motion (Chen et al. 2025, Offset Geometric
        /// Contact, Sect. 3.3).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_clearances(IntPtr surface, double max_distance, double*
            out_distances);

        /// <summary>Finds the earliest time at which a face and a vertex, or two edges, may meet.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_safe_step(IntPtr surface, ImpactDesc* desc, SafeStep* @out);

        /// <summary>Finds all pairs of FACE and VERTEX, or of EDGE and EDGE, that may meet during the motion.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_impacts(IntPtr surface, Feature a, Feature b, ImpactDesc* desc,
            ImpactView* out_view);

        /// <summary>Sets vox_surface_desc.cell_size for the following calls.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_set_cell_size(IntPtr surface, double cell_size);

        /// <summary>Suggests the cell size with the least cost for finding the pairs of kinds a and b.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_suggest_cell_size(IntPtr surface, Feature a, Feature b,
            CellSizeResult* @out);

        /// <summary>Gets counts of the last search and the bytes held (docs/surface-pairs.md lists them).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_get_counters(IntPtr surface, CounterView* out_view);

        /// <summary>Reads the file at `path` (for TetGen either file of the pair; the other must be beside it, as must
        /// files that a .gltf names). desc null: defaults.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_load(IntPtr path, IoLoadDesc* desc, IntPtr* out_mesh);

        /// <summary>The same from memory.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_read(IoSource* sources, UIntPtr source_count, IoLoadDesc* desc, IntPtr*
            out_mesh);

        /// <summary>Releases a mesh.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern void vox_io_mesh_destroy(IntPtr mesh);

        /// <summary>The mesh's arrays.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_mesh_get_arrays(IntPtr mesh, IoMeshView* out_view);

        /// <summary>Describes the mesh for vox_mesh_insert and vox_suggest_cell_size: sets positions, tets and
        /// tet_count, and leaves all other fields of `desc` as they are.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_mesh_describe(IntPtr mesh, MeshDesc* desc);

        /// <summary>Makes a mesh from arrays (copied) on the C++ runtime's heap.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_mesh_create(IoMeshView* arrays, IntPtr* out_mesh);

        /// <summary>Writes the fields that out_report-&gt;struct_size covers (set it first).</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_mesh_get_report(IntPtr mesh, IoReport* out_report);

        /// <summary>The problems in the report as text, one line each ("3 tets are inverted"); "" if there are
        /// none.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern IntPtr vox_io_mesh_get_warnings(IntPtr mesh);

        /// <summary>Name of a format, e.g. "Gmsh .msh".</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern IntPtr vox_io_format_string(IoFormat format);

        /// <summary>Fills the inside of a closed surface (the triangles of `surface`; its tets are ignored) with
        /// tetrahedra. desc null: defaults.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_tetrahedralize(IntPtr surface, IoTetrahedralizeDesc* desc, IntPtr*
            out_mesh);

        /// <summary>Measures `mesh` against the triangles of `surface`, which may be null.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_mesh_measure(IntPtr mesh, IntPtr surface, IoQuality* out_quality);

        /// <summary>Writes vertices, triangles and tets, in the mesh's order, and the tets' regions: as physical groups
        /// in .msh, as the cell array "region" in .vtu, unless cell_data has one of that name. desc null:
        /// defaults.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_write(IntPtr mesh, IntPtr path, IoWriteDesc* desc);

        /// <summary>As vox_io_write, but passes the bytes to `sink`. desc-&gt;format must not be AUTO.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_write_to(IntPtr mesh, IoWriteDesc* desc, IoSink* sink);

        /// <summary>A ball of `radius` around the origin, made of about `tet_count` tetrahedra.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_make_lattice_ball(ulong tet_count, double radius, IntPtr* out_mesh);

        /// <summary>A ball by isosurface stuffing on a lattice of cubes with edge `cell`.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_make_ball(double radius, double cell, IntPtr* out_mesh);

        /// <summary>A torus around the z axis.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_make_torus(double radius, double tube_radius, double cell, IntPtr*
            out_mesh);

        /// <summary>A capsule along the z axis.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_make_capsule(double radius, double length, double cell, IntPtr* out_mesh);

        /// <summary>A cylinder along the z axis.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_make_cylinder(double radius, double length, double cell, IntPtr* out_mesh);

        /// <summary>An exact box of cubes with edges of about `cell`, stretched so that a whole number of them fits
        /// each side, and split into five tets each.</summary>
        [DllImport(vox_io, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_io_make_box(double size_x, double size_y, double size_z, double cell, IntPtr*
            out_mesh);

        /// <summary>Creates a simulation without bodies.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_create(SimDesc* desc, IntPtr* out_sim);

        /// <summary>Destroys a simulation with its bodies and its grid.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern void vox_sim_destroy(IntPtr sim);

        /// <summary>Gets the grid inside, for reading results, for setting cell size and workers, and for rigid shapes:
        /// those inserted there hold and push the bodies.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_get_grid(IntPtr sim, IntPtr* out_grid);

        /// <summary>Advances everything by time_step.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_step(IntPtr sim, double time_step);

        /// <summary>Adds a body.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_body_insert(IntPtr sim, SimBodyDesc* desc, uint* out_body);

        /// <summary>Removes a body from the simulation and its grid.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_body_remove(IntPtr sim, uint body);

        /// <summary>Gets the arrays of a body.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_body_get_view(IntPtr sim, uint body, SimBodyView* out_view);

        /// <summary>Sets positions and velocities of a body, 3 * vertex_count numbers each; null leaves them as they
        /// are.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_body_set_state(IntPtr sim, uint body, double* positions, double*
            velocities);

        /// <summary>Gets energy and motion of a body, or of all bodies that are not fixed (VOX_NULL_BODY), in the
        /// middle of the last substep.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_get_energy(IntPtr sim, uint body, SimEnergy* out_energy);

        /// <summary>Gets sizes, totals and times (docs/sim.md lists them).</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_get_counters(IntPtr sim, CounterView* out_view);

        /// <summary>Moves bodies apart until no edge meets a face and all features without a common vertex are `gap`
        /// apart, by small steps of XPBD that keep the lengths of edges and the volumes of tetrahedra.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_resolve(ResolveDesc* desc, ResolveBody* bodies, ulong body_count,
            ResolveReport* out_report);
    }

    /// <summary>A size or an offset here, and what it is for the library.</summary>
    internal struct LayoutEntry
    {
        public string Name;
        public long Here, In64Bits, In32Bits;
        public long Expected { get { return IntPtr.Size == 8 ? In64Bits : In32Bits; } }
    }

    internal static unsafe class Layout
    {
        static LayoutEntry Entry(string name, long here, long in64Bits, long in32Bits)
        {
            return new LayoutEntry { Name = name, Here = here, In64Bits = in64Bits, In32Bits = in32Bits };
        }

        static void AddPositions(List<LayoutEntry> entries)
        {
            Positions s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_positions", sizeof(Positions), 40, 40));
            entries.Add(Entry("vox_positions.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_positions.count", (byte*)&s.count - begin, 8, 8));
            entries.Add(Entry("vox_positions.format", (byte*)&s.format - begin, 16, 16));
            entries.Add(Entry("vox_positions.reserved", (byte*)&s.reserved - begin, 20, 20));
            entries.Add(Entry("vox_positions.byte_stride", (byte*)&s.byte_stride - begin, 24, 24));
            entries.Add(Entry("vox_positions.component_byte_stride", (byte*)&s.component_byte_stride - begin, 32, 32));
        }

        static void AddGridDesc(List<LayoutEntry> entries)
        {
            GridDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_grid_desc", sizeof(GridDesc), 72, 56));
            entries.Add(Entry("vox_grid_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_grid_desc.flags", (byte*)&s.flags - begin, 4, 4));
            entries.Add(Entry("vox_grid_desc.worker_count", (byte*)&s.worker_count - begin, 8, 8));
            entries.Add(Entry("vox_grid_desc.max_constraints_per_pair", (byte*)&s.max_constraints_per_pair - begin, 12, 12));
            entries.Add(Entry("vox_grid_desc.cell_size", (byte*)&s.cell_size - begin, 16, 16));
            entries.Add(Entry("vox_grid_desc.margin", (byte*)&s.margin - begin, 24, 24));
            entries.Add(Entry("vox_grid_desc.byte_budget", (byte*)&s.byte_budget - begin, 32, 32));
            entries.Add(Entry("vox_grid_desc.allocator", (byte*)&s.allocator - begin, 40, 40));
            entries.Add(Entry("vox_grid_desc.log", (byte*)&s.log - begin, 48, 44));
            entries.Add(Entry("vox_grid_desc.tasks", (byte*)&s.tasks - begin, 56, 48));
            entries.Add(Entry("vox_grid_desc.reference", (byte*)&s.reference - begin, 64, 52));
        }

        static void AddFilter(List<LayoutEntry> entries)
        {
            Filter s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_filter", sizeof(Filter), 40, 40));
            entries.Add(Entry("vox_filter.flags", (byte*)&s.flags - begin, 0, 0));
            entries.Add(Entry("vox_filter.group", (byte*)&s.group - begin, 4, 4));
            entries.Add(Entry("vox_filter.category", (byte*)&s.category - begin, 8, 8));
            entries.Add(Entry("vox_filter.mask", (byte*)&s.mask - begin, 16, 16));
            entries.Add(Entry("vox_filter.world", (byte*)&s.world - begin, 24, 24));
            entries.Add(Entry("vox_filter.self_rings", (byte*)&s.self_rings - begin, 28, 28));
            entries.Add(Entry("vox_filter.self_rest_distance", (byte*)&s.self_rest_distance - begin, 32, 32));
        }

        static void AddMeshDesc(List<LayoutEntry> entries)
        {
            MeshDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_mesh_desc", sizeof(MeshDesc), 152, 152));
            entries.Add(Entry("vox_mesh_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_mesh_desc.flags", (byte*)&s.flags - begin, 4, 4));
            entries.Add(Entry("vox_mesh_desc.positions", (byte*)&s.positions - begin, 8, 8));
            entries.Add(Entry("vox_mesh_desc.tets", (byte*)&s.tets - begin, 48, 48));
            entries.Add(Entry("vox_mesh_desc.tet_count", (byte*)&s.tet_count - begin, 56, 56));
            entries.Add(Entry("vox_mesh_desc.user_data", (byte*)&s.user_data - begin, 64, 64));
            entries.Add(Entry("vox_mesh_desc.filter", (byte*)&s.filter - begin, 72, 72));
            entries.Add(Entry("vox_mesh_desc.rest_positions", (byte*)&s.rest_positions - begin, 112, 112));
        }

        static void AddContact(List<LayoutEntry> entries)
        {
            Contact s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_contact", sizeof(Contact), 16, 16));
            entries.Add(Entry("vox_contact.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_contact.vertex", (byte*)&s.vertex - begin, 4, 4));
            entries.Add(Entry("vox_contact.body_b", (byte*)&s.body_b - begin, 8, 8));
            entries.Add(Entry("vox_contact.tet", (byte*)&s.tet - begin, 12, 12));
        }

        static void AddContactView(List<LayoutEntry> entries)
        {
            ContactView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_contact_view", sizeof(ContactView), 24, 24));
            entries.Add(Entry("vox_contact_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_contact_view.count", (byte*)&s.count - begin, 8, 8));
            entries.Add(Entry("vox_contact_view.interiors", (byte*)&s.interiors - begin, 16, 16));
        }

        static void AddPair(List<LayoutEntry> entries)
        {
            Pair s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_pair", sizeof(Pair), 48, 48));
            entries.Add(Entry("vox_pair.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_pair.body_b", (byte*)&s.body_b - begin, 4, 4));
            entries.Add(Entry("vox_pair.user_data_a", (byte*)&s.user_data_a - begin, 8, 8));
            entries.Add(Entry("vox_pair.user_data_b", (byte*)&s.user_data_b - begin, 16, 16));
            entries.Add(Entry("vox_pair.state", (byte*)&s.state - begin, 24, 24));
            entries.Add(Entry("vox_pair.reserved", (byte*)&s.reserved - begin, 28, 28));
            entries.Add(Entry("vox_pair.first_contact", (byte*)&s.first_contact - begin, 32, 32));
            entries.Add(Entry("vox_pair.contact_count", (byte*)&s.contact_count - begin, 40, 40));
        }

        static void AddPairView(List<LayoutEntry> entries)
        {
            PairView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_pair_view", sizeof(PairView), 24, 24));
            entries.Add(Entry("vox_pair_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_pair_view.count", (byte*)&s.count - begin, 8, 8));
            entries.Add(Entry("vox_pair_view.contacts", (byte*)&s.contacts - begin, 16, 16));
        }

        static void AddConstraint(List<LayoutEntry> entries)
        {
            Constraint s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_constraint", sizeof(Constraint), 192, 192));
            entries.Add(Entry("vox_constraint.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_constraint.body_b", (byte*)&s.body_b - begin, 4, 4));
            entries.Add(Entry("vox_constraint.kind", (byte*)&s.kind - begin, 8, 8));
            entries.Add(Entry("vox_constraint.state", (byte*)&s.state - begin, 12, 12));
            entries.Add(Entry("vox_constraint.count_a", (byte*)&s.count_a - begin, 16, 16));
            entries.Add(Entry("vox_constraint.count", (byte*)&s.count - begin, 20, 20));
            entries.Add(Entry("vox_constraint.vertices", (byte*)&s.vertices - begin, 24, 24));
            entries.Add(Entry("vox_constraint.element_b", (byte*)&s.element_b - begin, 44, 44));
            entries.Add(Entry("vox_constraint.weights", (byte*)&s.weights - begin, 48, 48));
            entries.Add(Entry("vox_constraint.normal", (byte*)&s.normal - begin, 88, 88));
            entries.Add(Entry("vox_constraint.gap", (byte*)&s.gap - begin, 112, 112));
            entries.Add(Entry("vox_constraint.offset", (byte*)&s.offset - begin, 120, 120));
            entries.Add(Entry("vox_constraint.position", (byte*)&s.position - begin, 128, 128));
            entries.Add(Entry("vox_constraint.time", (byte*)&s.time - begin, 152, 152));
            entries.Add(Entry("vox_constraint.user_data_a", (byte*)&s.user_data_a - begin, 160, 160));
            entries.Add(Entry("vox_constraint.user_data_b", (byte*)&s.user_data_b - begin, 168, 168));
            entries.Add(Entry("vox_constraint.pair", (byte*)&s.pair - begin, 176, 176));
            entries.Add(Entry("vox_constraint.previous", (byte*)&s.previous - begin, 180, 180));
            entries.Add(Entry("vox_constraint.left_out", (byte*)&s.left_out - begin, 184, 184));
        }

        static void AddConstraintDesc(List<LayoutEntry> entries)
        {
            ConstraintDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_constraint_desc", sizeof(ConstraintDesc), 32, 32));
            entries.Add(Entry("vox_constraint_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_constraint_desc.method", (byte*)&s.method - begin, 4, 4));
            entries.Add(Entry("vox_constraint_desc.body_a", (byte*)&s.body_a - begin, 8, 8));
            entries.Add(Entry("vox_constraint_desc.body_b", (byte*)&s.body_b - begin, 12, 12));
            entries.Add(Entry("vox_constraint_desc.mask", (byte*)&s.mask - begin, 16, 16));
            entries.Add(Entry("vox_constraint_desc.closest_budget", (byte*)&s.closest_budget - begin, 24, 24));
        }

        static void AddConstraintView(List<LayoutEntry> entries)
        {
            ConstraintView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_constraint_view", sizeof(ConstraintView), 32, 32));
            entries.Add(Entry("vox_constraint_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_constraint_view.count", (byte*)&s.count - begin, 8, 8));
            entries.Add(Entry("vox_constraint_view.pair_offsets", (byte*)&s.pair_offsets - begin, 16, 16));
            entries.Add(Entry("vox_constraint_view.pair_count", (byte*)&s.pair_count - begin, 24, 24));
        }

        static void AddBodyInfo(List<LayoutEntry> entries)
        {
            BodyInfo s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_body_info", sizeof(BodyInfo), 216, 216));
            entries.Add(Entry("vox_body_info.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_body_info.shape", (byte*)&s.shape - begin, 4, 4));
            entries.Add(Entry("vox_body_info.user_data", (byte*)&s.user_data - begin, 8, 8));
            entries.Add(Entry("vox_body_info.enabled", (byte*)&s.enabled - begin, 16, 16));
            entries.Add(Entry("vox_body_info.flags", (byte*)&s.flags - begin, 20, 20));
            entries.Add(Entry("vox_body_info.tet_count", (byte*)&s.tet_count - begin, 24, 24));
            entries.Add(Entry("vox_body_info.enabled_tet_count", (byte*)&s.enabled_tet_count - begin, 32, 32));
            entries.Add(Entry("vox_body_info.positions", (byte*)&s.positions - begin, 40, 40));
            entries.Add(Entry("vox_body_info.filter", (byte*)&s.filter - begin, 80, 80));
            entries.Add(Entry("vox_body_info.transform", (byte*)&s.transform - begin, 120, 120));
        }

        static void AddShapeDesc(List<LayoutEntry> entries)
        {
            ShapeDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_shape_desc", sizeof(ShapeDesc), 200, 192));
            entries.Add(Entry("vox_shape_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_shape_desc.kind", (byte*)&s.kind - begin, 4, 4));
            entries.Add(Entry("vox_shape_desc.radius", (byte*)&s.radius - begin, 8, 8));
            entries.Add(Entry("vox_shape_desc.half_length", (byte*)&s.half_length - begin, 16, 16));
            entries.Add(Entry("vox_shape_desc.half_size", (byte*)&s.half_size - begin, 24, 24));
            entries.Add(Entry("vox_shape_desc.positions", (byte*)&s.positions - begin, 48, 48));
            entries.Add(Entry("vox_shape_desc.triangles", (byte*)&s.triangles - begin, 88, 88));
            entries.Add(Entry("vox_shape_desc.triangle_count", (byte*)&s.triangle_count - begin, 96, 96));
            entries.Add(Entry("vox_shape_desc.heights", (byte*)&s.heights - begin, 104, 104));
            entries.Add(Entry("vox_shape_desc.columns", (byte*)&s.columns - begin, 112, 108));
            entries.Add(Entry("vox_shape_desc.rows", (byte*)&s.rows - begin, 116, 112));
            entries.Add(Entry("vox_shape_desc.spacing", (byte*)&s.spacing - begin, 120, 120));
            entries.Add(Entry("vox_shape_desc.field", (byte*)&s.field - begin, 136, 136));
            entries.Add(Entry("vox_shape_desc.field_user", (byte*)&s.field_user - begin, 144, 140));
            entries.Add(Entry("vox_shape_desc.user_data", (byte*)&s.user_data - begin, 152, 144));
            entries.Add(Entry("vox_shape_desc.filter", (byte*)&s.filter - begin, 160, 152));
        }

        static void AddGridInfo(List<LayoutEntry> entries)
        {
            GridInfo s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_grid_info", sizeof(GridInfo), 88, 88));
            entries.Add(Entry("vox_grid_info.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_grid_info.flags", (byte*)&s.flags - begin, 4, 4));
            entries.Add(Entry("vox_grid_info.epoch", (byte*)&s.epoch - begin, 8, 8));
            entries.Add(Entry("vox_grid_info.cell_size", (byte*)&s.cell_size - begin, 16, 16));
            entries.Add(Entry("vox_grid_info.margin", (byte*)&s.margin - begin, 24, 24));
            entries.Add(Entry("vox_grid_info.bytes", (byte*)&s.bytes - begin, 32, 32));
            entries.Add(Entry("vox_grid_info.peak_bytes", (byte*)&s.peak_bytes - begin, 40, 40));
            entries.Add(Entry("vox_grid_info.step_ns", (byte*)&s.step_ns - begin, 48, 48));
            entries.Add(Entry("vox_grid_info.moved_bodies", (byte*)&s.moved_bodies - begin, 56, 56));
            entries.Add(Entry("vox_grid_info.skipped_bodies", (byte*)&s.skipped_bodies - begin, 64, 64));
            entries.Add(Entry("vox_grid_info.total_began", (byte*)&s.total_began - begin, 72, 72));
            entries.Add(Entry("vox_grid_info.total_ended", (byte*)&s.total_ended - begin, 80, 80));
        }

        static void AddCounter(List<LayoutEntry> entries)
        {
            Counter s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_counter", sizeof(Counter), 16, 16));
            entries.Add(Entry("vox_counter.name", (byte*)&s.name - begin, 0, 0));
            entries.Add(Entry("vox_counter.value", (byte*)&s.value - begin, 8, 8));
        }

        static void AddCounterView(List<LayoutEntry> entries)
        {
            CounterView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_counter_view", sizeof(CounterView), 16, 16));
            entries.Add(Entry("vox_counter_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_counter_view.count", (byte*)&s.count - begin, 8, 8));
        }

        static void AddFailure(List<LayoutEntry> entries)
        {
            Failure s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_failure", sizeof(Failure), 48, 48));
            entries.Add(Entry("vox_failure.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_failure.result", (byte*)&s.result - begin, 4, 4));
            entries.Add(Entry("vox_failure.body", (byte*)&s.body - begin, 8, 8));
            entries.Add(Entry("vox_failure.vertex", (byte*)&s.vertex - begin, 12, 12));
            entries.Add(Entry("vox_failure.user_data", (byte*)&s.user_data - begin, 16, 16));
            entries.Add(Entry("vox_failure.position", (byte*)&s.position - begin, 24, 24));
        }

        static void AddVerticesDesc(List<LayoutEntry> entries)
        {
            VerticesDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_vertices_desc", sizeof(VerticesDesc), 104, 104));
            entries.Add(Entry("vox_vertices_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_vertices_desc.reserved", (byte*)&s.reserved - begin, 4, 4));
            entries.Add(Entry("vox_vertices_desc.count", (byte*)&s.count - begin, 8, 8));
            entries.Add(Entry("vox_vertices_desc.positions", (byte*)&s.positions - begin, 16, 16));
            entries.Add(Entry("vox_vertices_desc.copies_of", (byte*)&s.copies_of - begin, 56, 56));
            entries.Add(Entry("vox_vertices_desc.rest_positions", (byte*)&s.rest_positions - begin, 64, 64));
        }

        static void AddAllocator(List<LayoutEntry> entries)
        {
            Allocator s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_allocator", sizeof(Allocator), 24, 12));
            entries.Add(Entry("vox_allocator.allocate", (byte*)&s.allocate - begin, 0, 0));
            entries.Add(Entry("vox_allocator.release", (byte*)&s.release - begin, 8, 4));
            entries.Add(Entry("vox_allocator.user", (byte*)&s.user - begin, 16, 8));
        }

        static void AddLog(List<LayoutEntry> entries)
        {
            Log s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_log", sizeof(Log), 16, 8));
            entries.Add(Entry("vox_log.write", (byte*)&s.write - begin, 0, 0));
            entries.Add(Entry("vox_log.user", (byte*)&s.user - begin, 8, 4));
        }

        static void AddTaskSystem(List<LayoutEntry> entries)
        {
            TaskSystem s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_task_system", sizeof(TaskSystem), 24, 12));
            entries.Add(Entry("vox_task_system.enqueue", (byte*)&s.enqueue - begin, 0, 0));
            entries.Add(Entry("vox_task_system.finish", (byte*)&s.finish - begin, 8, 4));
            entries.Add(Entry("vox_task_system.user", (byte*)&s.user - begin, 16, 8));
        }

        static void AddQueryDesc(List<LayoutEntry> entries)
        {
            QueryDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_query_desc", sizeof(QueryDesc), 32, 32));
            entries.Add(Entry("vox_query_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_query_desc.flags", (byte*)&s.flags - begin, 4, 4));
            entries.Add(Entry("vox_query_desc.mask", (byte*)&s.mask - begin, 8, 8));
            entries.Add(Entry("vox_query_desc.excluded", (byte*)&s.excluded - begin, 16, 16));
            entries.Add(Entry("vox_query_desc.reserved", (byte*)&s.reserved - begin, 20, 20));
            entries.Add(Entry("vox_query_desc.max_distance", (byte*)&s.max_distance - begin, 24, 24));
        }

        static void AddLocation(List<LayoutEntry> entries)
        {
            Location s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_location", sizeof(Location), 56, 56));
            entries.Add(Entry("vox_location.body", (byte*)&s.body - begin, 0, 0));
            entries.Add(Entry("vox_location.tet", (byte*)&s.tet - begin, 4, 4));
            entries.Add(Entry("vox_location.state", (byte*)&s.state - begin, 8, 8));
            entries.Add(Entry("vox_location.reserved", (byte*)&s.reserved - begin, 12, 12));
            entries.Add(Entry("vox_location.weights", (byte*)&s.weights - begin, 16, 16));
            entries.Add(Entry("vox_location.distance", (byte*)&s.distance - begin, 48, 48));
        }

        static void AddPointHit(List<LayoutEntry> entries)
        {
            PointHit s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_point_hit", sizeof(PointHit), 48, 48));
            entries.Add(Entry("vox_point_hit.point", (byte*)&s.point - begin, 0, 0));
            entries.Add(Entry("vox_point_hit.body", (byte*)&s.body - begin, 4, 4));
            entries.Add(Entry("vox_point_hit.tet", (byte*)&s.tet - begin, 8, 8));
            entries.Add(Entry("vox_point_hit.reserved", (byte*)&s.reserved - begin, 12, 12));
            entries.Add(Entry("vox_point_hit.weights", (byte*)&s.weights - begin, 16, 16));
        }

        static void AddClosestHit(List<LayoutEntry> entries)
        {
            ClosestHit s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_closest_hit", sizeof(ClosestHit), 112, 112));
            entries.Add(Entry("vox_closest_hit.body", (byte*)&s.body - begin, 0, 0));
            entries.Add(Entry("vox_closest_hit.tet", (byte*)&s.tet - begin, 4, 4));
            entries.Add(Entry("vox_closest_hit.facet", (byte*)&s.facet - begin, 8, 8));
            entries.Add(Entry("vox_closest_hit.inside", (byte*)&s.inside - begin, 12, 12));
            entries.Add(Entry("vox_closest_hit.face", (byte*)&s.face - begin, 16, 16));
            entries.Add(Entry("vox_closest_hit.reserved", (byte*)&s.reserved - begin, 28, 28));
            entries.Add(Entry("vox_closest_hit.weights", (byte*)&s.weights - begin, 32, 32));
            entries.Add(Entry("vox_closest_hit.position", (byte*)&s.position - begin, 56, 56));
            entries.Add(Entry("vox_closest_hit.normal", (byte*)&s.normal - begin, 80, 80));
            entries.Add(Entry("vox_closest_hit.distance", (byte*)&s.distance - begin, 104, 104));
        }

        static void AddBoxHit(List<LayoutEntry> entries)
        {
            BoxHit s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_box_hit", sizeof(BoxHit), 12, 12));
            entries.Add(Entry("vox_box_hit.box", (byte*)&s.box - begin, 0, 0));
            entries.Add(Entry("vox_box_hit.body", (byte*)&s.body - begin, 4, 4));
            entries.Add(Entry("vox_box_hit.tet", (byte*)&s.tet - begin, 8, 8));
        }

        static void AddRayHit(List<LayoutEntry> entries)
        {
            RayHit s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_ray_hit", sizeof(RayHit), 64, 64));
            entries.Add(Entry("vox_ray_hit.ray", (byte*)&s.ray - begin, 0, 0));
            entries.Add(Entry("vox_ray_hit.body", (byte*)&s.body - begin, 4, 4));
            entries.Add(Entry("vox_ray_hit.tet", (byte*)&s.tet - begin, 8, 8));
            entries.Add(Entry("vox_ray_hit.facet", (byte*)&s.facet - begin, 12, 12));
            entries.Add(Entry("vox_ray_hit.side", (byte*)&s.side - begin, 16, 16));
            entries.Add(Entry("vox_ray_hit.face", (byte*)&s.face - begin, 20, 20));
            entries.Add(Entry("vox_ray_hit.t", (byte*)&s.t - begin, 32, 32));
            entries.Add(Entry("vox_ray_hit.weights", (byte*)&s.weights - begin, 40, 40));
        }

        static void AddTrackPiece(List<LayoutEntry> entries)
        {
            TrackPiece s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_track_piece", sizeof(TrackPiece), 40, 40));
            entries.Add(Entry("vox_track_piece.segment", (byte*)&s.segment - begin, 0, 0));
            entries.Add(Entry("vox_track_piece.body", (byte*)&s.body - begin, 4, 4));
            entries.Add(Entry("vox_track_piece.tet", (byte*)&s.tet - begin, 8, 8));
            entries.Add(Entry("vox_track_piece.facet_in", (byte*)&s.facet_in - begin, 12, 12));
            entries.Add(Entry("vox_track_piece.facet_out", (byte*)&s.facet_out - begin, 16, 16));
            entries.Add(Entry("vox_track_piece.reserved", (byte*)&s.reserved - begin, 20, 20));
            entries.Add(Entry("vox_track_piece.t_in", (byte*)&s.t_in - begin, 24, 24));
            entries.Add(Entry("vox_track_piece.t_out", (byte*)&s.t_out - begin, 32, 32));
        }

        static void AddTriangleHit(List<LayoutEntry> entries)
        {
            TriangleHit s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_triangle_hit", sizeof(TriangleHit), 72, 72));
            entries.Add(Entry("vox_triangle_hit.triangle", (byte*)&s.triangle - begin, 0, 0));
            entries.Add(Entry("vox_triangle_hit.body", (byte*)&s.body - begin, 4, 4));
            entries.Add(Entry("vox_triangle_hit.tet", (byte*)&s.tet - begin, 8, 8));
            entries.Add(Entry("vox_triangle_hit.edges", (byte*)&s.edges - begin, 12, 12));
            entries.Add(Entry("vox_triangle_hit.t", (byte*)&s.t - begin, 16, 16));
            entries.Add(Entry("vox_triangle_hit.s", (byte*)&s.s - begin, 24, 24));
        }

        static void AddCostSample(List<LayoutEntry> entries)
        {
            CostSample s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_cost_sample", sizeof(CostSample), 16, 16));
            entries.Add(Entry("vox_cost_sample.cell_size", (byte*)&s.cell_size - begin, 0, 0));
            entries.Add(Entry("vox_cost_sample.cost", (byte*)&s.cost - begin, 8, 8));
        }

        static void AddCostTerm(List<LayoutEntry> entries)
        {
            CostTerm s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_cost_term", sizeof(CostTerm), 24, 24));
            entries.Add(Entry("vox_cost_term.name", (byte*)&s.name - begin, 0, 0));
            entries.Add(Entry("vox_cost_term.count", (byte*)&s.count - begin, 8, 8));
            entries.Add(Entry("vox_cost_term.cost", (byte*)&s.cost - begin, 16, 16));
        }

        static void AddCellSizeRule(List<LayoutEntry> entries)
        {
            CellSizeRule s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_cell_size_rule", sizeof(CellSizeRule), 24, 24));
            entries.Add(Entry("vox_cell_size_rule.name", (byte*)&s.name - begin, 0, 0));
            entries.Add(Entry("vox_cell_size_rule.cell_size", (byte*)&s.cell_size - begin, 8, 8));
            entries.Add(Entry("vox_cell_size_rule.cost", (byte*)&s.cost - begin, 16, 16));
        }

        static void AddTiming(List<LayoutEntry> entries)
        {
            Timing s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_timing", sizeof(Timing), 16, 16));
            entries.Add(Entry("vox_timing.cell_size", (byte*)&s.cell_size - begin, 0, 0));
            entries.Add(Entry("vox_timing.seconds", (byte*)&s.seconds - begin, 8, 8));
        }

        static void AddForeignWeights(List<LayoutEntry> entries)
        {
            ForeignWeights s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_foreign_weights", sizeof(ForeignWeights), 56, 56));
            entries.Add(Entry("vox_foreign_weights.run", (byte*)&s.run - begin, 0, 0));
            entries.Add(Entry("vox_foreign_weights.store", (byte*)&s.store - begin, 8, 8));
            entries.Add(Entry("vox_foreign_weights.visit", (byte*)&s.visit - begin, 16, 16));
            entries.Add(Entry("vox_foreign_weights.found", (byte*)&s.found - begin, 24, 24));
            entries.Add(Entry("vox_foreign_weights.read", (byte*)&s.read - begin, 32, 32));
            entries.Add(Entry("vox_foreign_weights.occupied", (byte*)&s.occupied - begin, 40, 40));
            entries.Add(Entry("vox_foreign_weights.cell", (byte*)&s.cell - begin, 48, 48));
        }

        static void AddCellSizeResult(List<LayoutEntry> entries)
        {
            CellSizeResult s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_cell_size_result", sizeof(CellSizeResult), 2416, 2416));
            entries.Add(Entry("vox_cell_size_result.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_cell_size_result.warnings", (byte*)&s.warnings - begin, 4, 4));
            entries.Add(Entry("vox_cell_size_result.cell_size", (byte*)&s.cell_size - begin, 8, 8));
            entries.Add(Entry("vox_cell_size_result.zone_min", (byte*)&s.zone_min - begin, 16, 16));
            entries.Add(Entry("vox_cell_size_result.zone_max", (byte*)&s.zone_max - begin, 24, 24));
            entries.Add(Entry("vox_cell_size_result.cost", (byte*)&s.cost - begin, 32, 32));
            entries.Add(Entry("vox_cell_size_result.min_cell_size", (byte*)&s.min_cell_size - begin, 40, 40));
            entries.Add(Entry("vox_cell_size_result.cells_per_axis", (byte*)&s.cells_per_axis - begin, 48, 48));
            entries.Add(Entry("vox_cell_size_result.fit_error", (byte*)&s.fit_error - begin, 56, 56));
            entries.Add(Entry("vox_cell_size_result.expected_loss", (byte*)&s.expected_loss - begin, 64, 64));
            entries.Add(Entry("vox_cell_size_result.curve_count", (byte*)&s.curve_count - begin, 72, 72));
            entries.Add(Entry("vox_cell_size_result.term_count", (byte*)&s.term_count - begin, 76, 76));
            entries.Add(Entry("vox_cell_size_result.rule_count", (byte*)&s.rule_count - begin, 80, 80));
            entries.Add(Entry("vox_cell_size_result.timing_count", (byte*)&s.timing_count - begin, 84, 84));
            entries.Add(Entry("vox_cell_size_result.curve", (byte*)&s.curve - begin, 88, 88));
            entries.Add(Entry("vox_cell_size_result.terms", (byte*)&s.terms - begin, 1112, 1112));
            entries.Add(Entry("vox_cell_size_result.rules", (byte*)&s.rules - begin, 1400, 1400));
            entries.Add(Entry("vox_cell_size_result.timings", (byte*)&s.timings - begin, 1592, 1592));
            entries.Add(Entry("vox_cell_size_result.weights", (byte*)&s.weights - begin, 2104, 2104));
            entries.Add(Entry("vox_cell_size_result.note", (byte*)&s.note - begin, 2160, 2160));
        }

        static void AddCostWeights(List<LayoutEntry> entries)
        {
            CostWeights s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_cost_weights", sizeof(CostWeights), 200, 200));
            entries.Add(Entry("vox_cost_weights.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_cost_weights.measured", (byte*)&s.measured - begin, 4, 4));
            entries.Add(Entry("vox_cost_weights.ns", (byte*)&s.ns - begin, 8, 8));
        }

        static void AddReferenceDesc(List<LayoutEntry> entries)
        {
            ReferenceDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_reference_desc", sizeof(ReferenceDesc), 72, 72));
            entries.Add(Entry("vox_reference_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_reference_desc.flags", (byte*)&s.flags - begin, 4, 4));
            entries.Add(Entry("vox_reference_desc.hash_table_size", (byte*)&s.hash_table_size - begin, 8, 8));
            entries.Add(Entry("vox_reference_desc.world_min", (byte*)&s.world_min - begin, 16, 16));
            entries.Add(Entry("vox_reference_desc.world_max", (byte*)&s.world_max - begin, 40, 40));
            entries.Add(Entry("vox_reference_desc.weights", (byte*)&s.weights - begin, 64, 64));
        }

        static void AddCellSizeDesc(List<LayoutEntry> entries)
        {
            CellSizeDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_cell_size_desc", sizeof(CellSizeDesc), 72, 64));
            entries.Add(Entry("vox_cell_size_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_cell_size_desc.model", (byte*)&s.model - begin, 4, 4));
            entries.Add(Entry("vox_cell_size_desc.reference_flags", (byte*)&s.reference_flags - begin, 8, 8));
            entries.Add(Entry("vox_cell_size_desc.reserved", (byte*)&s.reserved - begin, 12, 12));
            entries.Add(Entry("vox_cell_size_desc.zone_loss", (byte*)&s.zone_loss - begin, 16, 16));
            entries.Add(Entry("vox_cell_size_desc.p_nc", (byte*)&s.p_nc - begin, 24, 24));
            entries.Add(Entry("vox_cell_size_desc.cost_ratio", (byte*)&s.cost_ratio - begin, 32, 32));
            entries.Add(Entry("vox_cell_size_desc.world_edge", (byte*)&s.world_edge - begin, 40, 40));
            entries.Add(Entry("vox_cell_size_desc.byte_budget", (byte*)&s.byte_budget - begin, 48, 48));
            entries.Add(Entry("vox_cell_size_desc.weights", (byte*)&s.weights - begin, 56, 56));
            entries.Add(Entry("vox_cell_size_desc.allocator", (byte*)&s.allocator - begin, 64, 60));
        }

        static void AddGeometry(List<LayoutEntry> entries)
        {
            Geometry s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_geometry", sizeof(Geometry), 168, 168));
            entries.Add(Entry("vox_geometry.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_geometry.reserved", (byte*)&s.reserved - begin, 4, 4));
            entries.Add(Entry("vox_geometry.vertices", (byte*)&s.vertices - begin, 8, 8));
            entries.Add(Entry("vox_geometry.tets", (byte*)&s.tets - begin, 16, 16));
            entries.Add(Entry("vox_geometry.edges", (byte*)&s.edges - begin, 24, 24));
            entries.Add(Entry("vox_geometry.facets", (byte*)&s.facets - begin, 32, 32));
            entries.Add(Entry("vox_geometry.boundary_facets", (byte*)&s.boundary_facets - begin, 40, 40));
            entries.Add(Entry("vox_geometry.degenerate_tets", (byte*)&s.degenerate_tets - begin, 48, 48));
            entries.Add(Entry("vox_geometry.mean_edge", (byte*)&s.mean_edge - begin, 56, 56));
            entries.Add(Entry("vox_geometry.mean_longest_edge", (byte*)&s.mean_longest_edge - begin, 64, 64));
            entries.Add(Entry("vox_geometry.mean_box_side", (byte*)&s.mean_box_side - begin, 72, 72));
            entries.Add(Entry("vox_geometry.median_box_side", (byte*)&s.median_box_side - begin, 80, 80));
            entries.Add(Entry("vox_geometry.mean_facet_area", (byte*)&s.mean_facet_area - begin, 88, 88));
            entries.Add(Entry("vox_geometry.mean_tet_facet_area", (byte*)&s.mean_tet_facet_area - begin, 96, 96));
            entries.Add(Entry("vox_geometry.mean_boundary_facet_area", (byte*)&s.mean_boundary_facet_area - begin, 104, 104));
            entries.Add(Entry("vox_geometry.mean_volume", (byte*)&s.mean_volume - begin, 112, 112));
            entries.Add(Entry("vox_geometry.bounds_min", (byte*)&s.bounds_min - begin, 120, 120));
            entries.Add(Entry("vox_geometry.bounds_max", (byte*)&s.bounds_max - begin, 144, 144));
        }

        static void AddPrimitives(List<LayoutEntry> entries)
        {
            Primitives s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_primitives", sizeof(Primitives), 104, 104));
            entries.Add(Entry("vox_primitives.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_primitives.type", (byte*)&s.type - begin, 4, 4));
            entries.Add(Entry("vox_primitives.positions", (byte*)&s.positions - begin, 8, 8));
            entries.Add(Entry("vox_primitives.indices", (byte*)&s.indices - begin, 48, 48));
            entries.Add(Entry("vox_primitives.index_byte_stride", (byte*)&s.index_byte_stride - begin, 56, 56));
            entries.Add(Entry("vox_primitives.count", (byte*)&s.count - begin, 64, 64));
            entries.Add(Entry("vox_primitives.radii", (byte*)&s.radii - begin, 72, 72));
            entries.Add(Entry("vox_primitives.radius_byte_stride", (byte*)&s.radius_byte_stride - begin, 80, 80));
            entries.Add(Entry("vox_primitives.radius_format", (byte*)&s.radius_format - begin, 88, 88));
            entries.Add(Entry("vox_primitives.reserved", (byte*)&s.reserved - begin, 92, 92));
            entries.Add(Entry("vox_primitives.radius", (byte*)&s.radius - begin, 96, 96));
        }

        static void AddForeignGrid(List<LayoutEntry> entries)
        {
            ForeignGrid s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_foreign_grid", sizeof(ForeignGrid), 128, 120));
            entries.Add(Entry("vox_foreign_grid.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_foreign_grid.known", (byte*)&s.known - begin, 4, 4));
            entries.Add(Entry("vox_foreign_grid.cells_stored", (byte*)&s.cells_stored - begin, 8, 8));
            entries.Add(Entry("vox_foreign_grid.cells_queried", (byte*)&s.cells_queried - begin, 12, 12));
            entries.Add(Entry("vox_foreign_grid.cells_kept", (byte*)&s.cells_kept - begin, 16, 16));
            entries.Add(Entry("vox_foreign_grid.reserved", (byte*)&s.reserved - begin, 20, 20));
            entries.Add(Entry("vox_foreign_grid.stored", (byte*)&s.stored - begin, 24, 24));
            entries.Add(Entry("vox_foreign_grid.querying", (byte*)&s.querying - begin, 32, 28));
            entries.Add(Entry("vox_foreign_grid.radius", (byte*)&s.radius - begin, 40, 32));
            entries.Add(Entry("vox_foreign_grid.min_cell_size", (byte*)&s.min_cell_size - begin, 48, 40));
            entries.Add(Entry("vox_foreign_grid.zone_loss", (byte*)&s.zone_loss - begin, 56, 48));
            entries.Add(Entry("vox_foreign_grid.weights", (byte*)&s.weights - begin, 64, 56));
            entries.Add(Entry("vox_foreign_grid.allocator", (byte*)&s.allocator - begin, 120, 112));
        }

        static void AddForeignCounts(List<LayoutEntry> entries)
        {
            ForeignCounts s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_foreign_counts", sizeof(ForeignCounts), 48, 48));
            entries.Add(Entry("vox_foreign_counts.stored", (byte*)&s.stored - begin, 0, 0));
            entries.Add(Entry("vox_foreign_counts.visits", (byte*)&s.visits - begin, 8, 8));
            entries.Add(Entry("vox_foreign_counts.empty", (byte*)&s.empty - begin, 16, 16));
            entries.Add(Entry("vox_foreign_counts.reads", (byte*)&s.reads - begin, 24, 24));
            entries.Add(Entry("vox_foreign_counts.occupied", (byte*)&s.occupied - begin, 32, 32));
            entries.Add(Entry("vox_foreign_counts.cells", (byte*)&s.cells - begin, 40, 40));
        }

        static void AddTuneDesc(List<LayoutEntry> entries)
        {
            TuneDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_tune_desc", sizeof(TuneDesc), 40, 40));
            entries.Add(Entry("vox_tune_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_tune_desc.max_runs", (byte*)&s.max_runs - begin, 4, 4));
            entries.Add(Entry("vox_tune_desc.min", (byte*)&s.min - begin, 8, 8));
            entries.Add(Entry("vox_tune_desc.max", (byte*)&s.max - begin, 16, 16));
            entries.Add(Entry("vox_tune_desc.first", (byte*)&s.first - begin, 24, 24));
            entries.Add(Entry("vox_tune_desc.wanted_loss", (byte*)&s.wanted_loss - begin, 32, 32));
        }

        static void AddSurfaceDesc(List<LayoutEntry> entries)
        {
            SurfaceDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_surface_desc", sizeof(SurfaceDesc), 112, 88));
            entries.Add(Entry("vox_surface_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_surface_desc.worker_count", (byte*)&s.worker_count - begin, 4, 4));
            entries.Add(Entry("vox_surface_desc.vertex_count", (byte*)&s.vertex_count - begin, 8, 8));
            entries.Add(Entry("vox_surface_desc.edge_count", (byte*)&s.edge_count - begin, 16, 16));
            entries.Add(Entry("vox_surface_desc.face_count", (byte*)&s.face_count - begin, 24, 24));
            entries.Add(Entry("vox_surface_desc.edges", (byte*)&s.edges - begin, 32, 32));
            entries.Add(Entry("vox_surface_desc.faces", (byte*)&s.faces - begin, 40, 36));
            entries.Add(Entry("vox_surface_desc.patches", (byte*)&s.patches - begin, 48, 40));
            entries.Add(Entry("vox_surface_desc.patch_categories", (byte*)&s.patch_categories - begin, 56, 44));
            entries.Add(Entry("vox_surface_desc.patch_masks", (byte*)&s.patch_masks - begin, 64, 48));
            entries.Add(Entry("vox_surface_desc.patch_count", (byte*)&s.patch_count - begin, 72, 56));
            entries.Add(Entry("vox_surface_desc.cell_size", (byte*)&s.cell_size - begin, 80, 64));
            entries.Add(Entry("vox_surface_desc.byte_budget", (byte*)&s.byte_budget - begin, 88, 72));
            entries.Add(Entry("vox_surface_desc.allocator", (byte*)&s.allocator - begin, 96, 80));
            entries.Add(Entry("vox_surface_desc.tasks", (byte*)&s.tasks - begin, 104, 84));
        }

        static void AddFeatureView(List<LayoutEntry> entries)
        {
            FeatureView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_feature_view", sizeof(FeatureView), 16, 16));
            entries.Add(Entry("vox_feature_view.vertices", (byte*)&s.vertices - begin, 0, 0));
            entries.Add(Entry("vox_feature_view.count", (byte*)&s.count - begin, 8, 8));
        }

        static void AddMotion(List<LayoutEntry> entries)
        {
            Motion s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_motion", sizeof(Motion), 96, 96));
            entries.Add(Entry("vox_motion.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_motion.flags", (byte*)&s.flags - begin, 4, 4));
            entries.Add(Entry("vox_motion.from", (byte*)&s.from - begin, 8, 8));
            entries.Add(Entry("vox_motion.to", (byte*)&s.to - begin, 48, 48));
            entries.Add(Entry("vox_motion.radius", (byte*)&s.radius - begin, 88, 88));
        }

        static void AddPartnerLists(List<LayoutEntry> entries)
        {
            PartnerLists s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_partner_lists", sizeof(PartnerLists), 32, 24));
            entries.Add(Entry("vox_partner_lists.offsets", (byte*)&s.offsets - begin, 0, 0));
            entries.Add(Entry("vox_partner_lists.partners", (byte*)&s.partners - begin, 8, 4));
            entries.Add(Entry("vox_partner_lists.first", (byte*)&s.first - begin, 16, 8));
            entries.Add(Entry("vox_partner_lists.count", (byte*)&s.count - begin, 24, 16));
        }

        static void AddCrossing(List<LayoutEntry> entries)
        {
            Crossing s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_crossing", sizeof(Crossing), 80, 80));
            entries.Add(Entry("vox_crossing.edge", (byte*)&s.edge - begin, 0, 0));
            entries.Add(Entry("vox_crossing.face", (byte*)&s.face - begin, 4, 4));
            entries.Add(Entry("vox_crossing.kind", (byte*)&s.kind - begin, 8, 8));
            entries.Add(Entry("vox_crossing.reserved", (byte*)&s.reserved - begin, 12, 12));
            entries.Add(Entry("vox_crossing.edge_weights", (byte*)&s.edge_weights - begin, 16, 16));
            entries.Add(Entry("vox_crossing.face_weights", (byte*)&s.face_weights - begin, 32, 32));
            entries.Add(Entry("vox_crossing.position", (byte*)&s.position - begin, 56, 56));
        }

        static void AddCrossingView(List<LayoutEntry> entries)
        {
            CrossingView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_crossing_view", sizeof(CrossingView), 16, 16));
            entries.Add(Entry("vox_crossing_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_crossing_view.count", (byte*)&s.count - begin, 8, 8));
        }

        static void AddProximity(List<LayoutEntry> entries)
        {
            Proximity s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_proximity", sizeof(Proximity), 112, 112));
            entries.Add(Entry("vox_proximity.a", (byte*)&s.a - begin, 0, 0));
            entries.Add(Entry("vox_proximity.b", (byte*)&s.b - begin, 4, 4));
            entries.Add(Entry("vox_proximity.distance", (byte*)&s.distance - begin, 8, 8));
            entries.Add(Entry("vox_proximity.weights_a", (byte*)&s.weights_a - begin, 16, 16));
            entries.Add(Entry("vox_proximity.weights_b", (byte*)&s.weights_b - begin, 40, 40));
            entries.Add(Entry("vox_proximity.point_a", (byte*)&s.point_a - begin, 64, 64));
            entries.Add(Entry("vox_proximity.point_b", (byte*)&s.point_b - begin, 88, 88));
        }

        static void AddProximityView(List<LayoutEntry> entries)
        {
            ProximityView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_proximity_view", sizeof(ProximityView), 16, 16));
            entries.Add(Entry("vox_proximity_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_proximity_view.count", (byte*)&s.count - begin, 8, 8));
        }

        static void AddImpactDesc(List<LayoutEntry> entries)
        {
            ImpactDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_impact_desc", sizeof(ImpactDesc), 24, 24));
            entries.Add(Entry("vox_impact_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_impact_desc.max_iterations", (byte*)&s.max_iterations - begin, 4, 4));
            entries.Add(Entry("vox_impact_desc.distance", (byte*)&s.distance - begin, 8, 8));
            entries.Add(Entry("vox_impact_desc.slack", (byte*)&s.slack - begin, 16, 16));
        }

        static void AddSafeStep(List<LayoutEntry> entries)
        {
            SafeStep s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_safe_step", sizeof(SafeStep), 40, 40));
            entries.Add(Entry("vox_safe_step.step", (byte*)&s.step - begin, 0, 0));
            entries.Add(Entry("vox_safe_step.pairs", (byte*)&s.pairs - begin, 8, 8));
            entries.Add(Entry("vox_safe_step.kind_a", (byte*)&s.kind_a - begin, 16, 16));
            entries.Add(Entry("vox_safe_step.kind_b", (byte*)&s.kind_b - begin, 20, 20));
            entries.Add(Entry("vox_safe_step.a", (byte*)&s.a - begin, 24, 24));
            entries.Add(Entry("vox_safe_step.b", (byte*)&s.b - begin, 28, 28));
            entries.Add(Entry("vox_safe_step.unfinished", (byte*)&s.unfinished - begin, 32, 32));
            entries.Add(Entry("vox_safe_step.reserved", (byte*)&s.reserved - begin, 36, 36));
        }

        static void AddImpact(List<LayoutEntry> entries)
        {
            Impact s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_impact", sizeof(Impact), 16, 16));
            entries.Add(Entry("vox_impact.a", (byte*)&s.a - begin, 0, 0));
            entries.Add(Entry("vox_impact.b", (byte*)&s.b - begin, 4, 4));
            entries.Add(Entry("vox_impact.time", (byte*)&s.time - begin, 8, 8));
        }

        static void AddImpactView(List<LayoutEntry> entries)
        {
            ImpactView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_impact_view", sizeof(ImpactView), 16, 16));
            entries.Add(Entry("vox_impact_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_impact_view.count", (byte*)&s.count - begin, 8, 8));
        }

        static void AddIoLoadDesc(List<LayoutEntry> entries)
        {
            IoLoadDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_load_desc", sizeof(IoLoadDesc), 40, 28));
            entries.Add(Entry("vox_io_load_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_io_load_desc.format", (byte*)&s.format - begin, 4, 4));
            entries.Add(Entry("vox_io_load_desc.mesh", (byte*)&s.mesh - begin, 8, 8));
            entries.Add(Entry("vox_io_load_desc.flags", (byte*)&s.flags - begin, 12, 12));
            entries.Add(Entry("vox_io_load_desc.allocator", (byte*)&s.allocator - begin, 16, 16));
            entries.Add(Entry("vox_io_load_desc.progress", (byte*)&s.progress - begin, 24, 20));
            entries.Add(Entry("vox_io_load_desc.progress_user", (byte*)&s.progress_user - begin, 32, 24));
        }

        static void AddIoSource(List<LayoutEntry> entries)
        {
            IoSource s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_source", sizeof(IoSource), 24, 12));
            entries.Add(Entry("vox_io_source.name", (byte*)&s.name - begin, 0, 0));
            entries.Add(Entry("vox_io_source.data", (byte*)&s.data - begin, 8, 4));
            entries.Add(Entry("vox_io_source.size", (byte*)&s.size - begin, 16, 8));
        }

        static void AddIoMeshView(List<LayoutEntry> entries)
        {
            IoMeshView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_mesh_view", sizeof(IoMeshView), 72, 64));
            entries.Add(Entry("vox_io_mesh_view.positions", (byte*)&s.positions - begin, 0, 0));
            entries.Add(Entry("vox_io_mesh_view.vertex_count", (byte*)&s.vertex_count - begin, 8, 8));
            entries.Add(Entry("vox_io_mesh_view.tets", (byte*)&s.tets - begin, 16, 16));
            entries.Add(Entry("vox_io_mesh_view.tet_count", (byte*)&s.tet_count - begin, 24, 24));
            entries.Add(Entry("vox_io_mesh_view.triangles", (byte*)&s.triangles - begin, 32, 32));
            entries.Add(Entry("vox_io_mesh_view.triangle_count", (byte*)&s.triangle_count - begin, 40, 40));
            entries.Add(Entry("vox_io_mesh_view.tet_regions", (byte*)&s.tet_regions - begin, 48, 48));
            entries.Add(Entry("vox_io_mesh_view.file_vertices", (byte*)&s.file_vertices - begin, 56, 52));
            entries.Add(Entry("vox_io_mesh_view.tet_cells", (byte*)&s.tet_cells - begin, 64, 56));
        }

        static void AddIoReport(List<LayoutEntry> entries)
        {
            IoReport s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_report", sizeof(IoReport), 240, 240));
            entries.Add(Entry("vox_io_report.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_io_report.format", (byte*)&s.format - begin, 4, 4));
            entries.Add(Entry("vox_io_report.vertices", (byte*)&s.vertices - begin, 8, 8));
            entries.Add(Entry("vox_io_report.tets", (byte*)&s.tets - begin, 16, 16));
            entries.Add(Entry("vox_io_report.triangles", (byte*)&s.triangles - begin, 24, 24));
            entries.Add(Entry("vox_io_report.skipped_elements", (byte*)&s.skipped_elements - begin, 32, 32));
            entries.Add(Entry("vox_io_report.second_order_tets", (byte*)&s.second_order_tets - begin, 40, 40));
            entries.Add(Entry("vox_io_report.inverted_tets", (byte*)&s.inverted_tets - begin, 48, 48));
            entries.Add(Entry("vox_io_report.degenerate_tets", (byte*)&s.degenerate_tets - begin, 56, 56));
            entries.Add(Entry("vox_io_report.nearly_flat_tets", (byte*)&s.nearly_flat_tets - begin, 64, 64));
            entries.Add(Entry("vox_io_report.duplicate_tets", (byte*)&s.duplicate_tets - begin, 72, 72));
            entries.Add(Entry("vox_io_report.degenerate_triangles", (byte*)&s.degenerate_triangles - begin, 80, 80));
            entries.Add(Entry("vox_io_report.duplicate_vertices", (byte*)&s.duplicate_vertices - begin, 88, 88));
            entries.Add(Entry("vox_io_report.unused_vertices", (byte*)&s.unused_vertices - begin, 96, 96));
            entries.Add(Entry("vox_io_report.boundary_facets", (byte*)&s.boundary_facets - begin, 104, 104));
            entries.Add(Entry("vox_io_report.non_manifold_facets", (byte*)&s.non_manifold_facets - begin, 112, 112));
            entries.Add(Entry("vox_io_report.open_edges", (byte*)&s.open_edges - begin, 120, 120));
            entries.Add(Entry("vox_io_report.misoriented_edges", (byte*)&s.misoriented_edges - begin, 128, 128));
            entries.Add(Entry("vox_io_report.components", (byte*)&s.components - begin, 136, 136));
            entries.Add(Entry("vox_io_report.volume", (byte*)&s.volume - begin, 144, 144));
            entries.Add(Entry("vox_io_report.bounds_min", (byte*)&s.bounds_min - begin, 152, 152));
            entries.Add(Entry("vox_io_report.bounds_max", (byte*)&s.bounds_max - begin, 176, 176));
            entries.Add(Entry("vox_io_report.unit_in_metres", (byte*)&s.unit_in_metres - begin, 200, 200));
            entries.Add(Entry("vox_io_report.left_out_vertices", (byte*)&s.left_out_vertices - begin, 208, 208));
            entries.Add(Entry("vox_io_report.left_out_triangles", (byte*)&s.left_out_triangles - begin, 216, 216));
            entries.Add(Entry("vox_io_report.split_cells", (byte*)&s.split_cells - begin, 224, 224));
            entries.Add(Entry("vox_io_report.left_out_tets", (byte*)&s.left_out_tets - begin, 232, 232));
        }

        static void AddIoTetrahedralizeDesc(List<LayoutEntry> entries)
        {
            IoTetrahedralizeDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_tetrahedralize_desc", sizeof(IoTetrahedralizeDesc), 64, 56));
            entries.Add(Entry("vox_io_tetrahedralize_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_io_tetrahedralize_desc.kind", (byte*)&s.kind - begin, 4, 4));
            entries.Add(Entry("vox_io_tetrahedralize_desc.cell", (byte*)&s.cell - begin, 8, 8));
            entries.Add(Entry("vox_io_tetrahedralize_desc.max_tets", (byte*)&s.max_tets - begin, 16, 16));
            entries.Add(Entry("vox_io_tetrahedralize_desc.max_distance", (byte*)&s.max_distance - begin, 24, 24));
            entries.Add(Entry("vox_io_tetrahedralize_desc.coarsen", (byte*)&s.coarsen - begin, 32, 32));
            entries.Add(Entry("vox_io_tetrahedralize_desc.reserved", (byte*)&s.reserved - begin, 36, 36));
            entries.Add(Entry("vox_io_tetrahedralize_desc.progress", (byte*)&s.progress - begin, 40, 40));
            entries.Add(Entry("vox_io_tetrahedralize_desc.progress_user", (byte*)&s.progress_user - begin, 48, 44));
            entries.Add(Entry("vox_io_tetrahedralize_desc.allocator", (byte*)&s.allocator - begin, 56, 48));
        }

        static void AddIoQuality(List<LayoutEntry> entries)
        {
            IoQuality s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_quality", sizeof(IoQuality), 88, 88));
            entries.Add(Entry("vox_io_quality.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_io_quality.reserved", (byte*)&s.reserved - begin, 4, 4));
            entries.Add(Entry("vox_io_quality.vertices", (byte*)&s.vertices - begin, 8, 8));
            entries.Add(Entry("vox_io_quality.tets", (byte*)&s.tets - begin, 16, 16));
            entries.Add(Entry("vox_io_quality.boundary_facets", (byte*)&s.boundary_facets - begin, 24, 24));
            entries.Add(Entry("vox_io_quality.min_dihedral", (byte*)&s.min_dihedral - begin, 32, 32));
            entries.Add(Entry("vox_io_quality.max_dihedral", (byte*)&s.max_dihedral - begin, 40, 40));
            entries.Add(Entry("vox_io_quality.volume", (byte*)&s.volume - begin, 48, 48));
            entries.Add(Entry("vox_io_quality.surface_volume", (byte*)&s.surface_volume - begin, 56, 56));
            entries.Add(Entry("vox_io_quality.mesh_to_surface", (byte*)&s.mesh_to_surface - begin, 64, 64));
            entries.Add(Entry("vox_io_quality.surface_to_mesh", (byte*)&s.surface_to_mesh - begin, 72, 72));
            entries.Add(Entry("vox_io_quality.hausdorff", (byte*)&s.hausdorff - begin, 80, 80));
        }

        static void AddIoPointData(List<LayoutEntry> entries)
        {
            IoPointData s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_point_data", sizeof(IoPointData), 24, 16));
            entries.Add(Entry("vox_io_point_data.name", (byte*)&s.name - begin, 0, 0));
            entries.Add(Entry("vox_io_point_data.values", (byte*)&s.values - begin, 8, 4));
            entries.Add(Entry("vox_io_point_data.components", (byte*)&s.components - begin, 16, 8));
            entries.Add(Entry("vox_io_point_data.reserved", (byte*)&s.reserved - begin, 20, 12));
        }

        static void AddIoWriteDesc(List<LayoutEntry> entries)
        {
            IoWriteDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_write_desc", sizeof(IoWriteDesc), 48, 48));
            entries.Add(Entry("vox_io_write_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_io_write_desc.format", (byte*)&s.format - begin, 4, 4));
            entries.Add(Entry("vox_io_write_desc.binary", (byte*)&s.binary - begin, 8, 8));
            entries.Add(Entry("vox_io_write_desc.reserved", (byte*)&s.reserved - begin, 12, 12));
            entries.Add(Entry("vox_io_write_desc.point_data", (byte*)&s.point_data - begin, 16, 16));
            entries.Add(Entry("vox_io_write_desc.point_data_count", (byte*)&s.point_data_count - begin, 24, 24));
            entries.Add(Entry("vox_io_write_desc.cell_data", (byte*)&s.cell_data - begin, 32, 32));
            entries.Add(Entry("vox_io_write_desc.cell_data_count", (byte*)&s.cell_data_count - begin, 40, 40));
        }

        static void AddIoSink(List<LayoutEntry> entries)
        {
            IoSink s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_sink", sizeof(IoSink), 16, 8));
            entries.Add(Entry("vox_io_sink.write", (byte*)&s.write - begin, 0, 0));
            entries.Add(Entry("vox_io_sink.user", (byte*)&s.user - begin, 8, 4));
        }

        static void AddSimDesc(List<LayoutEntry> entries)
        {
            SimDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_sim_desc", sizeof(SimDesc), 136, 128));
            entries.Add(Entry("vox_sim_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_sim_desc.substeps", (byte*)&s.substeps - begin, 4, 4));
            entries.Add(Entry("vox_sim_desc.detect_every", (byte*)&s.detect_every - begin, 8, 8));
            entries.Add(Entry("vox_sim_desc.reserved", (byte*)&s.reserved - begin, 12, 12));
            entries.Add(Entry("vox_sim_desc.gravity", (byte*)&s.gravity - begin, 16, 16));
            entries.Add(Entry("vox_sim_desc.max_time_step", (byte*)&s.max_time_step - begin, 40, 40));
            entries.Add(Entry("vox_sim_desc.floor_normal", (byte*)&s.floor_normal - begin, 48, 48));
            entries.Add(Entry("vox_sim_desc.floor_offset", (byte*)&s.floor_offset - begin, 72, 72));
            entries.Add(Entry("vox_sim_desc.friction", (byte*)&s.friction - begin, 80, 80));
            entries.Add(Entry("vox_sim_desc.contact_compliance", (byte*)&s.contact_compliance - begin, 88, 88));
            entries.Add(Entry("vox_sim_desc.max_push_speed", (byte*)&s.max_push_speed - begin, 96, 96));
            entries.Add(Entry("vox_sim_desc.contact_slop", (byte*)&s.contact_slop - begin, 104, 104));
            entries.Add(Entry("vox_sim_desc.grid", (byte*)&s.grid - begin, 112, 112));
            entries.Add(Entry("vox_sim_desc.log", (byte*)&s.log - begin, 120, 116));
            entries.Add(Entry("vox_sim_desc.allocator", (byte*)&s.allocator - begin, 128, 120));
        }

        static void AddSimBodyDesc(List<LayoutEntry> entries)
        {
            SimBodyDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_sim_body_desc", sizeof(SimBodyDesc), 96, 80));
            entries.Add(Entry("vox_sim_body_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_sim_body_desc.flags", (byte*)&s.flags - begin, 4, 4));
            entries.Add(Entry("vox_sim_body_desc.positions", (byte*)&s.positions - begin, 8, 8));
            entries.Add(Entry("vox_sim_body_desc.rest_positions", (byte*)&s.rest_positions - begin, 16, 12));
            entries.Add(Entry("vox_sim_body_desc.velocities", (byte*)&s.velocities - begin, 24, 16));
            entries.Add(Entry("vox_sim_body_desc.tets", (byte*)&s.tets - begin, 32, 20));
            entries.Add(Entry("vox_sim_body_desc.vertex_count", (byte*)&s.vertex_count - begin, 40, 24));
            entries.Add(Entry("vox_sim_body_desc.tet_count", (byte*)&s.tet_count - begin, 48, 32));
            entries.Add(Entry("vox_sim_body_desc.density", (byte*)&s.density - begin, 56, 40));
            entries.Add(Entry("vox_sim_body_desc.youngs_modulus", (byte*)&s.youngs_modulus - begin, 64, 48));
            entries.Add(Entry("vox_sim_body_desc.bulk_modulus", (byte*)&s.bulk_modulus - begin, 72, 56));
            entries.Add(Entry("vox_sim_body_desc.damping", (byte*)&s.damping - begin, 80, 64));
            entries.Add(Entry("vox_sim_body_desc.user_data", (byte*)&s.user_data - begin, 88, 72));
        }

        static void AddSimBodyView(List<LayoutEntry> entries)
        {
            SimBodyView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_sim_body_view", sizeof(SimBodyView), 56, 40));
            entries.Add(Entry("vox_sim_body_view.positions", (byte*)&s.positions - begin, 0, 0));
            entries.Add(Entry("vox_sim_body_view.velocities", (byte*)&s.velocities - begin, 8, 4));
            entries.Add(Entry("vox_sim_body_view.masses", (byte*)&s.masses - begin, 16, 8));
            entries.Add(Entry("vox_sim_body_view.grid_positions", (byte*)&s.grid_positions - begin, 24, 12));
            entries.Add(Entry("vox_sim_body_view.tets", (byte*)&s.tets - begin, 32, 16));
            entries.Add(Entry("vox_sim_body_view.vertex_count", (byte*)&s.vertex_count - begin, 40, 24));
            entries.Add(Entry("vox_sim_body_view.tet_count", (byte*)&s.tet_count - begin, 48, 32));
        }

        static void AddSimEnergy(List<LayoutEntry> entries)
        {
            SimEnergy s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_sim_energy", sizeof(SimEnergy), 88, 88));
            entries.Add(Entry("vox_sim_energy.kinetic", (byte*)&s.kinetic - begin, 0, 0));
            entries.Add(Entry("vox_sim_energy.potential", (byte*)&s.potential - begin, 8, 8));
            entries.Add(Entry("vox_sim_energy.elastic", (byte*)&s.elastic - begin, 16, 16));
            entries.Add(Entry("vox_sim_energy.mass", (byte*)&s.mass - begin, 24, 24));
            entries.Add(Entry("vox_sim_energy.momentum", (byte*)&s.momentum - begin, 32, 32));
            entries.Add(Entry("vox_sim_energy.centre", (byte*)&s.centre - begin, 56, 56));
            entries.Add(Entry("vox_sim_energy.max_speed", (byte*)&s.max_speed - begin, 80, 80));
        }

        static void AddResolveBody(List<LayoutEntry> entries)
        {
            ResolveBody s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_resolve_body", sizeof(ResolveBody), 96, 96));
            entries.Add(Entry("vox_resolve_body.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_resolve_body.flags", (byte*)&s.flags - begin, 4, 4));
            entries.Add(Entry("vox_resolve_body.positions", (byte*)&s.positions - begin, 8, 8));
            entries.Add(Entry("vox_resolve_body.vertex_count", (byte*)&s.vertex_count - begin, 16, 16));
            entries.Add(Entry("vox_resolve_body.tets", (byte*)&s.tets - begin, 24, 24));
            entries.Add(Entry("vox_resolve_body.tet_count", (byte*)&s.tet_count - begin, 32, 32));
            entries.Add(Entry("vox_resolve_body.faces", (byte*)&s.faces - begin, 40, 40));
            entries.Add(Entry("vox_resolve_body.face_count", (byte*)&s.face_count - begin, 48, 48));
            entries.Add(Entry("vox_resolve_body.moved_vertices", (byte*)&s.moved_vertices - begin, 56, 56));
            entries.Add(Entry("vox_resolve_body.largest_move", (byte*)&s.largest_move - begin, 64, 64));
            entries.Add(Entry("vox_resolve_body.volume_before", (byte*)&s.volume_before - begin, 72, 72));
            entries.Add(Entry("vox_resolve_body.volume", (byte*)&s.volume - begin, 80, 80));
            entries.Add(Entry("vox_resolve_body.inverted_tets", (byte*)&s.inverted_tets - begin, 88, 88));
        }

        static void AddResolvePlace(List<LayoutEntry> entries)
        {
            ResolvePlace s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_resolve_place", sizeof(ResolvePlace), 40, 40));
            entries.Add(Entry("vox_resolve_place.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_resolve_place.body_b", (byte*)&s.body_b - begin, 4, 4));
            entries.Add(Entry("vox_resolve_place.distance", (byte*)&s.distance - begin, 8, 8));
            entries.Add(Entry("vox_resolve_place.position", (byte*)&s.position - begin, 16, 16));
        }

        static void AddResolveDesc(List<LayoutEntry> entries)
        {
            ResolveDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_resolve_desc", sizeof(ResolveDesc), 56, 56));
            entries.Add(Entry("vox_resolve_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_resolve_desc.worker_count", (byte*)&s.worker_count - begin, 4, 4));
            entries.Add(Entry("vox_resolve_desc.max_iterations", (byte*)&s.max_iterations - begin, 8, 8));
            entries.Add(Entry("vox_resolve_desc.reserved", (byte*)&s.reserved - begin, 12, 12));
            entries.Add(Entry("vox_resolve_desc.gap", (byte*)&s.gap - begin, 16, 16));
            entries.Add(Entry("vox_resolve_desc.max_move", (byte*)&s.max_move - begin, 24, 24));
            entries.Add(Entry("vox_resolve_desc.places", (byte*)&s.places - begin, 32, 32));
            entries.Add(Entry("vox_resolve_desc.place_capacity", (byte*)&s.place_capacity - begin, 40, 40));
            entries.Add(Entry("vox_resolve_desc.allocator", (byte*)&s.allocator - begin, 48, 48));
        }

        static void AddResolveReport(List<LayoutEntry> entries)
        {
            ResolveReport s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_resolve_report", sizeof(ResolveReport), 80, 80));
            entries.Add(Entry("vox_resolve_report.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_resolve_report.resolved", (byte*)&s.resolved - begin, 4, 4));
            entries.Add(Entry("vox_resolve_report.first_crossings", (byte*)&s.first_crossings - begin, 8, 8));
            entries.Add(Entry("vox_resolve_report.crossings", (byte*)&s.crossings - begin, 16, 16));
            entries.Add(Entry("vox_resolve_report.inside_vertices", (byte*)&s.inside_vertices - begin, 24, 24));
            entries.Add(Entry("vox_resolve_report.close_pairs", (byte*)&s.close_pairs - begin, 32, 32));
            entries.Add(Entry("vox_resolve_report.first_depth", (byte*)&s.first_depth - begin, 40, 40));
            entries.Add(Entry("vox_resolve_report.least_distance", (byte*)&s.least_distance - begin, 48, 48));
            entries.Add(Entry("vox_resolve_report.largest_move", (byte*)&s.largest_move - begin, 56, 56));
            entries.Add(Entry("vox_resolve_report.iterations", (byte*)&s.iterations - begin, 64, 64));
            entries.Add(Entry("vox_resolve_report.place_count", (byte*)&s.place_count - begin, 72, 72));
        }

        /// <summary>All structs and fields. A program whose entries differ must not call the library.</summary>
        internal static List<LayoutEntry> Entries()
        {
            var entries = new List<LayoutEntry>();
            AddPositions(entries);
            AddGridDesc(entries);
            AddFilter(entries);
            AddMeshDesc(entries);
            AddContact(entries);
            AddContactView(entries);
            AddPair(entries);
            AddPairView(entries);
            AddConstraint(entries);
            AddConstraintDesc(entries);
            AddConstraintView(entries);
            AddBodyInfo(entries);
            AddShapeDesc(entries);
            AddGridInfo(entries);
            AddCounter(entries);
            AddCounterView(entries);
            AddFailure(entries);
            AddVerticesDesc(entries);
            AddAllocator(entries);
            AddLog(entries);
            AddTaskSystem(entries);
            AddQueryDesc(entries);
            AddLocation(entries);
            AddPointHit(entries);
            AddClosestHit(entries);
            AddBoxHit(entries);
            AddRayHit(entries);
            AddTrackPiece(entries);
            AddTriangleHit(entries);
            AddCostSample(entries);
            AddCostTerm(entries);
            AddCellSizeRule(entries);
            AddTiming(entries);
            AddForeignWeights(entries);
            AddCellSizeResult(entries);
            AddCostWeights(entries);
            AddReferenceDesc(entries);
            AddCellSizeDesc(entries);
            AddGeometry(entries);
            AddPrimitives(entries);
            AddForeignGrid(entries);
            AddForeignCounts(entries);
            AddTuneDesc(entries);
            AddSurfaceDesc(entries);
            AddFeatureView(entries);
            AddMotion(entries);
            AddPartnerLists(entries);
            AddCrossing(entries);
            AddCrossingView(entries);
            AddProximity(entries);
            AddProximityView(entries);
            AddImpactDesc(entries);
            AddSafeStep(entries);
            AddImpact(entries);
            AddImpactView(entries);
            AddIoLoadDesc(entries);
            AddIoSource(entries);
            AddIoMeshView(entries);
            AddIoReport(entries);
            AddIoTetrahedralizeDesc(entries);
            AddIoQuality(entries);
            AddIoPointData(entries);
            AddIoWriteDesc(entries);
            AddIoSink(entries);
            AddSimDesc(entries);
            AddSimBodyDesc(entries);
            AddSimBodyView(entries);
            AddSimEnergy(entries);
            AddResolveBody(entries);
            AddResolvePlace(entries);
            AddResolveDesc(entries);
            AddResolveReport(entries);
            return entries;
        }
    }
}
