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
        /// <summary>a null pointer, an unknown enum, a bad number</summary>
        ErrorInvalidArgument = -1,
        /// <summary>a mesh id that is null, stale or from another grid</summary>
        ErrorInvalidHandle = -2,
        /// <summary>a tetrahedron names a vertex that does not exist</summary>
        ErrorInvalidMesh = -3,
        /// <summary>the call does not fit the state, e.g. no positions bound</summary>
        ErrorInvalidState = -4,
        /// <summary>a position is NaN or infinite</summary>
        ErrorNonFinite = -5,
        /// <summary>a documented limit would be passed</summary>
        ErrorLimit = -6,
        /// <summary>the grid's byte budget would be passed</summary>
        ErrorBudget = -7,
        /// <summary>the allocator returned null</summary>
        ErrorOutOfMemory = -8,
        /// <summary>recognised, but not supported by this build or version; or the processor is an x86-64 without
        /// SSE4.2: nothing is created there, and no cell size found</summary>
        ErrorUnsupported = -9,
        /// <summary>a file cannot be opened, read or written</summary>
        ErrorFile = -10,
        /// <summary>a file is malformed</summary>
        ErrorFormat = -11,
        /// <summary>a defect of the library: please report it</summary>
        ErrorInternal = -12,
    }

    public enum Format : int
    {
        /// <summary>IEEE 754 singles</summary>
        Float = 0,
        /// <summary>IEEE 754 doubles, of magnitudes below 2^128 - 2^103 (3.4028236e38), the largest float</summary>
        Double = 1,
    }

    [Flags]
    public enum GridFlags : uint
    {
        /// <summary>run the depth stage in a step (vox_grid_penetrations); on by default.</summary>
        Penetrations = 1,
        /// <summary>also report events of single vertices (vox_grid_contact_events)</summary>
        ContactEvents = 2,
        /// <summary>a mesh with a coordinate that VOX_FORMAT_DOUBLE does not allow (NaN, infinite, too large) takes no
        /// part in a step, in vox_grid_suggest_cell_size and in locators (vox_query.h), as if it were disabled; without
        /// this flag they fail.</summary>
        SkipBadBodies = 4,
        /// <summary>also find edges of surfaces through faces of others (vox_grid_edge_contacts);
        /// experimental.</summary>
        EdgeContacts = 8,
    }

    [Flags]
    public enum FilterFlags : uint
    {
        /// <summary>the mesh also collides with itself</summary>
        SelfCollision = 1,
        /// <summary>the mesh has contacts, but no penetrations; takes less memory</summary>
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

    /// <summary>How a penetration's depth and direction were found.</summary>
    public enum PenetrationState : int
    {
        /// <summary>edges lead from p out of body_b; mean over the points where they cross the surface</summary>
        Surface = 0,
        /// <summary>all neighbours of p collide; mean over those closer to the surface</summary>
        Propagated = 1,
        /// <summary>closest: no edge leads out from p or from a colliding vertex connected with it, or p has no edges,
        /// as in meshes without tetrahedra</summary>
        Enclosed = 2,
        /// <summary>the means are unusable, as the normals nearly cancel (edges leave on opposite sides), the depth
        /// would not be positive, or an edge that leads out crosses no surface (inverted tetrahedra, non-manifold
        /// facets); or this is the case for all vertices that p is connected with.</summary>
        Crossing = 3,
        /// <summary>p lies on the surface; depth is 0, direction the surface's normal at p</summary>
        Coincident = 4,
        /// <summary>the step's closest_budget was used up (see vox_grid_desc): depth is 0, direction the normal of a
        /// facet of the contact's tetrahedron</summary>
        Unknown = 5,
    }

    /// <summary>How an edge meets a face.</summary>
    public enum CrossingKind : int
    {
        /// <summary>it passes through the interior of the face, with an end on either side</summary>
        Through = 0,
        /// <summary>an end is on the face, or it passes through an edge or a corner of the face</summary>
        Touching = 1,
        /// <summary>it lies in the plane of the face and meets it, or one of them is degenerate and they meet</summary>
        Coplanar = 2,
    }

    /// <summary>What an event reports: how the last successful step differs from the successful step before
    /// it.</summary>
    public enum Touch : int
    {
        /// <summary>touches now, and did not before</summary>
        Began = 1,
        /// <summary>touches now, and did before</summary>
        Persisted = 2,
        /// <summary>no longer touches, for whatever reason</summary>
        Ended = 3,
    }

    /// <summary>Which parts of a vox_reading are wanted, or present; all fields of the other parts are zero.</summary>
    [Flags]
    public enum ReadingFlags : uint
    {
        /// <summary>missing if the vertex or its mesh was removed after the step</summary>
        Position = 1,
        /// <summary>missing where POSITION is or would be, if body_b was removed or has no surface, or if all of its
        /// tetrahedra that contained the vertex were removed or disabled</summary>
        Surface = 2,
        /// <summary>missing on grids without VOX_GRID_PENETRATIONS, and where one of the meshes is a sensor</summary>
        Depth = 4,
    }

    /// <summary>Severity of a log line.</summary>
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
    }

    public enum Side : int
    {
        /// <summary>the facet's tetrahedron has no volume</summary>
        None = 0,
        /// <summary>the ray goes into the tetrahedron</summary>
        Enters = 1,
        Leaves = 2,
    }

    [Flags]
    public enum ReferenceFlags : uint
    {
        /// <summary>store a list for every cell of a box (linear id k*nx*ny + j*nx + i), instead of hashing cells into
        /// a table</summary>
        Dense = 1,
        /// <summary>hash by i*73856093 xor j*19349663 xor k*83492791 (Teschner et al. 2003, Sect. 4.1), instead of by a
        /// well-mixed hash</summary>
        PaperHash = 2,
    }

    public enum CostModel : int
    {
        /// <summary>the paper's z(delta) (Sect. 4, Eqs. 3-8), from means; in cell visits</summary>
        Paper = 0,
        /// <summary>the reference engine, counted tet by tet; in nanoseconds of a step</summary>
        Reference = 1,
        /// <summary>the fast engine with one cell size in all windows; in nanoseconds of a step</summary>
        Fast = 2,
        /// <summary>the searches of vox_surface.h in the meshes' surfaces, for pairs of edges and of faces and
        /// vertices; in nanoseconds, of their grids alone</summary>
        Surface = 3,
    }

    /// <summary>How s, the size of a tetrahedron in Eq. 4, is measured.</summary>
    public enum SizeReading : int
    {
        /// <summary>mean length of the unique edges; reproduces the paper's tables</summary>
        MeanEdge = 0,
        /// <summary>mean over tets of the longest edge; as worded in Sect. 4.2</summary>
        MeanLongestEdge = 1,
        /// <summary>mean over tets of the longest side of the bounding box</summary>
        MeanBoxSide = 2,
    }

    /// <summary>How A, the facet area in Eqs. 5-7, is measured.</summary>
    public enum AreaReading : int
    {
        /// <summary>mean over all facets, shared ones counted once; reproduces the paper's tables</summary>
        UniqueFacets = 0,
        /// <summary>mean over the four facets of every tet</summary>
        TetFacets = 1,
        /// <summary>mean over the facets of exactly one tet</summary>
        BoundaryFacets = 2,
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
        /// <summary>two: opposite corners of a box along the axes, in any order</summary>
        Box = 4,
    }

    /// <summary>Which cells hold a primitive.</summary>
    public enum CellContent : int
    {
        /// <summary>all that its box meets</summary>
        CellsHoldBoxes = 0,
        /// <summary>the one with the centre of its box; for a point, with the point</summary>
        CellsHoldCentres = 1,
    }

    /// <summary>Which cells a primitive that asks looks at.</summary>
    public enum CellLook : int
    {
        /// <summary>those that its box meets: one for a point, those of the ball's box for one with a radius</summary>
        Box = 0,
        /// <summary>27: the one with the centre of its box, and those around.</summary>
        Around = 1,
        /// <summary>nobody asks: the grid goes through the cells and pairs what is in each.</summary>
        Pairs = 2,
    }

    /// <summary>Grids that weights are shipped for, each measured by bench/foreign.</summary>
    public enum KnownGrid : int
    {
        /// <summary>nothing is known: weights that lose least in the worst of the grids below</summary>
        Any = 0,
        /// <summary>a plain grid in C++: a counting sort into a dense lattice</summary>
        Sorted = 1,
        /// <summary>a plain grid in C++: std::unordered_map from cell to list</summary>
        Hashed = 2,
        /// <summary>NVIDIA Warp's HashGrid on the processor: points, asked by balls</summary>
        Warp = 3,
        /// <summary>IPC Toolkit's SpatialHash: boxes in all their cells, asked by boxes</summary>
        Ipc = 4,
        /// <summary>IPC Toolkit's HashGrid: boxes in all their cells, paired cell by cell</summary>
        IpcPairs = 5,
        /// <summary>VTK's vtkStaticCellLocator: boxes in all their cells, asked by points</summary>
        Vtk = 6,
        /// <summary>PBAT's HashGrid3: centres of boxes, asked from 27 cells</summary>
        Pbat = 7,
        /// <summary>hashed voxels of points asked by balls, as in PCL and Open3D</summary>
        PointVoxels = 8,
        /// <summary>a grid of sorted keys in numpy</summary>
        Numpy = 9,
    }

    [Flags]
    public enum ForeignFlags : uint
    {
        /// <summary>the grid keeps a list for each cell of the box of all that it holds</summary>
        Dense = 1,
    }

    /// <summary>What an answer was based on, combined with |.</summary>
    [Flags]
    public enum ForeignWarnings : uint
    {
        /// <summary>nothing is known of the grid's times: a few timings would help</summary>
        WeightsUnknown = 1,
        /// <summary>cell_size is that of `rule`: by the weights, a guess, no gain over it is sure</summary>
        ByRule = 2,
        /// <summary>the least legal size; a smaller one would be faster</summary>
        AtLeastSize = 4,
        /// <summary>the primitives have no size: the cell size follows from their distances</summary>
        NoSize = 8,
        /// <summary>all are in one place: any cell size that is large enough does</summary>
        OnePlace = 16,
        /// <summary>the timings do not follow the counts of the described grid</summary>
        ModelDisagrees = 32,
        /// <summary>timings at the same cell size differ widely</summary>
        TimingsDisagree = 64,
        /// <summary>the best cell size is beyond those timed</summary>
        OutOfRange = 128,
        /// <summary>the callback stopped, or failed at a cell size</summary>
        Stopped = 256,
    }

    /// <summary>The rules of vox_foreign_rules, in its order.</summary>
    public enum ForeignRule : int
    {
        /// <summary>the model's minimum</summary>
        None = 0,
        MeanEdge = 1,
        MeanBoxSide = 2,
        MedianBoxSide = 3,
        Spacing = 4,
        Radius = 5,
    }

    /// <summary>What a surface consists of.</summary>
    public enum Feature : int
    {
        Vertex = 0,
        /// <summary>of 2 vertices</summary>
        Edge = 1,
        /// <summary>a triangle, of 3 vertices</summary>
        Face = 2,
    }

    [Flags]
    public enum MotionFlags : uint
    {
        /// <summary>Leave out pairs that are proven to stay further apart than twice the radius, that is, whose
        /// features thickened by the radius never touch.</summary>
        Cull = 1,
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
        /// <summary>legacy .vtk, 2.0 to 5.1; ASCII and binary</summary>
        Vtk = 5,
        /// <summary>XML .vtu: ASCII, base64, appended; raw or zlib.</summary>
        Vtu = 6,
        /// <summary>.stl, .obj, .ply, .off, .gltf, .glb; triangles, no tets</summary>
        Surface = 7,
        /// <summary>Any other surface that assimp reads. assimp is not made for damaged files: they can end the
        /// process, keep it busy without end and fill its memory.</summary>
        Assimp = 8,
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
        /// <summary>collides with itself too</summary>
        SelfCollision = 1,
        /// <summary>never moves; others collide with it</summary>
        Fixed = 2,
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
    public unsafe struct Float4
    {
        public float x, y, z, w;
        public const int Length = 4;
        public float this[int i]
        {
            get { Check(i); fixed (float* p = &x) return p[i]; }
            set { Check(i); fixed (float* p = &x) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Float3
    {
        public float x, y, z;
        public const int Length = 3;
        public float this[int i]
        {
            get { Check(i); fixed (float* p = &x) return p[i]; }
            set { Check(i); fixed (float* p = &x) p[i] = value; }
        }
        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Uint2
    {
        public uint x, y;
        public const int Length = 2;
        public uint this[int i]
        {
            get { Check(i); fixed (uint* p = &x) return p[i]; }
            set { Check(i); fixed (uint* p = &x) p[i] = value; }
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

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Byte24
    {
        public byte e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11, e12, e13, e14, e15, e16, e17, e18, e19, e20, e21,
            e22, e23;
        public const int Length = 24;
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
                while (end < 24 && p[end] != 0) ++end;
                return System.Text.Encoding.UTF8.GetString(p, end);
            }
        }
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
    public unsafe struct CostShare12
    {
        public CostShare e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11;
        public const int Length = 12;
        public CostShare this[int i]
        {
            get { Check(i); fixed (CostShare* p = &e0) return p[i]; }
            set { Check(i); fixed (CostShare* p = &e0) p[i] = value; }
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
    public unsafe struct GridTiming32
    {
        public GridTiming e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11, e12, e13, e14, e15, e16, e17, e18, e19, e20,
            e21, e22, e23, e24, e25, e26, e27, e28, e29, e30, e31;
        public const int Length = 32;
        public GridTiming this[int i]
        {
            get { Check(i); fixed (GridTiming* p = &e0) return p[i]; }
            set { Check(i); fixed (GridTiming* p = &e0) p[i] = value; }
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

    /// <summary>Settings of a grid.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct GridDesc
    {
        public uint struct_size;
        /// <summary>vox_grid_flags, combined with |</summary>
        public GridFlags flags;
        /// <summary>Threads that share a step, the calling one being one of them: up to VOX_MAX_WORKERS, or
        /// VOX_ALL_CORES; 0: one.</summary>
        public uint worker_count;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>Edge length of a cell; 0: the library chooses it.</summary>
        public double cell_size;
        /// <summary>see vox_grid_set_margin.</summary>
        public double margin;
        /// <summary>most bytes the grid may hold; a call that would exceed it fails with VOX_ERROR_BUDGET. 0: 4 GiB;
        /// UINT64_MAX: no limit</summary>
        public ulong byte_budget;
        /// <summary>Most searches for a closest point that the depth stage makes in one step: for penetrations that
        /// would be ENCLOSED, or CROSSING with nothing but a closest point to go by.</summary>
        public ulong closest_budget;
        /// <summary>null: the C++ runtime's heap</summary>
        public Allocator* allocator;
        /// <summary>null: no log</summary>
        public Log* log;
        /// <summary>null: the built-in scheduler</summary>
        public TaskSystem* tasks;
        /// <summary>null: the fast engine; else the paper's</summary>
        public ReferenceDesc* reference;
    }

    /// <summary>A grid as it is now, and what its last successful step did.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 88)]
    public struct GridInfo
    {
        public uint struct_size;
        /// <summary>vox_grid_flags, combined with |</summary>
        public GridFlags flags;
        /// <summary>Number of steps, clears, reserves and changes of flags or margin so far, failed steps
        /// included.</summary>
        public ulong epoch;
        /// <summary>The cell size that was set, or else the last one that was chosen; 0 before the first
        /// step.</summary>
        public double cell_size;
        public double margin;
        /// <summary>held now, without the caller's arrays</summary>
        public ulong bytes;
        public ulong peak_bytes;
        /// <summary>nanoseconds</summary>
        public ulong step_ns;
        /// <summary>bodies that were not at rest (see vox_grid_step)</summary>
        public ulong moved_bodies;
        /// <summary>bodies that were left out (VOX_GRID_SKIP_BAD_BODIES)</summary>
        public ulong skipped_bodies;
        /// <summary>pairs that began, in all steps so far</summary>
        public ulong total_began;
        /// <summary>pairs that ended, in all steps so far</summary>
        public ulong total_ended;
    }

    /// <summary>What a mesh collides with.</summary>
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
        /// <summary>Self-contact skips tetrahedra that have a corner within this many edges of the vertex, along the
        /// edges of the mesh's tetrahedra; at most VOX_MAX_RINGS. 0 skips only tetrahedra that have the vertex as a
        /// corner.</summary>
        public uint self_rings;
        /// <summary>Self-contact skips tetrahedra that are closer to the vertex than this in the rest pose (distance to
        /// the closed tetrahedron, computed in double).</summary>
        public double self_rest_distance;
    }

    /// <summary>A body: vertices, and tetrahedra over them.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct MeshDesc
    {
        public uint struct_size;
        /// <summary>vox_mesh_flags, combined with |</summary>
        public MeshFlags flags;
        /// <summary>positions.count is the number of vertices.</summary>
        public Positions positions;
        /// <summary>tet_count * 4 vertex indices, copied unless VOX_MESH_BORROW_TETS is set.</summary>
        public uint* tets;
        public ulong tet_count;
        /// <summary>any number of the caller's, returned by vox_body_get_user_data</summary>
        public ulong user_data;
        public Filter filter;
        /// <summary>of all vertices, copied; none: see vox_filter.self_rest_distance</summary>
        public Positions rest_positions;
    }

    /// <summary>A mesh as it is now, e.g. after vox_grid_load.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct BodyInfo
    {
        public uint struct_size;
        /// <summary>from 0</summary>
        public uint slot;
        /// <summary>as given at insertion</summary>
        public ulong user_data;
        /// <summary>with those that are disabled or removed: indices of tetrahedra are below it</summary>
        public ulong tet_count;
        public ulong enabled_tet_count;
        /// <summary>1, or 0 (see vox_body_set_enabled)</summary>
        public uint enabled;
        /// <summary>vox_mesh_flags: COPY_POSITIONS if the positions are the mesh's own (copied, mapped or loaded),
        /// BORROW_TETS while the tetrahedra are the caller's</summary>
        public MeshFlags flags;
        /// <summary>1 if vox_body_set_transform gave it one</summary>
        public uint has_transform;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>The positions, without the transform; removed vertices are among them.</summary>
        public Positions positions;
        /// <summary>as vox_body_set_transform; without one the rows 1 0 0 0, 0 1 0 0, 0 0 1 0</summary>
        public Double12 transform;
        /// <summary>in use: neither category nor mask is 0</summary>
        public Filter filter;
    }

    /// <summary>Vertices to append.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct VerticesDesc
    {
        public uint struct_size;
        /// <summary>0</summary>
        public uint reserved;
        public ulong count;
        /// <summary>For a mesh that borrows its positions: an array of all positions, first those of the vertices it
        /// has, then those of the new ones.</summary>
        public Positions positions;
        /// <summary>Null, or `count` indices of earlier vertices of the mesh: the vertex that each new one is a copy
        /// of.</summary>
        public uint* copies_of;
        /// <summary>For meshes with a rest pose (vox_filter.self_rest_distance): `count` positions in it,
        /// copied.</summary>
        public Positions rest_positions;
    }

    /// <summary>A mesh that made a step fail, or that a step left out.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 56)]
    public struct Failure
    {
        public uint struct_size;
        /// <summary>NON_FINITE or LIMIT (a coordinate that VOX_FORMAT_DOUBLE does not allow), INVALID_STATE (no
        /// positions), INVALID_ARGUMENT (doubles under VOX_FORMAT_FLOAT); VOX_OK if there is none</summary>
        public Result result;
        /// <summary>VOX_NULL_BODY if there is none</summary>
        public uint mesh;
        /// <summary>of the mesh, from 0</summary>
        public uint slot;
        /// <summary>of the mesh, as given at insertion</summary>
        public ulong user_data;
        /// <summary>the first with such a coordinate; VOX_NO_VERTEX if the failure is about none</summary>
        public uint vertex;
        public uint reserved;
        /// <summary>of that vertex, as it would collide: in double and transformed; else 0</summary>
        public Double3 position;
    }

    /// <summary>Vertex `vertex` of body_a is in the closed tetrahedron `tet` of body_b and is not a corner of
    /// it.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 32)]
    public struct Contact
    {
        public uint body_a;
        public uint vertex;
        public uint body_b;
        public uint tet;
        public Float4 barycentric;
    }

    /// <summary>`count` contacts, `byte_stride` apart, sorted by (body_a, vertex, body_b, tet).</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ContactView
    {
        public Contact* data;
        public UIntPtr byte_stride;
        public ulong count;
        public ulong epoch;
        /// <summary>One for each contact: 1 if the vertex is in the interior of the tetrahedron, 0 if it is on its
        /// boundary; exact.</summary>
        public byte* interiors;
    }

    /// <summary>Vertex `vertex` of body_a is inside body_b (a = b: self-contact) and has to leave it: moving the vertex
    /// by depth * direction leads to the surface of body_b, exactly if the state says closest, and otherwise as well as
    /// edges and neighbours can estimate it.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 40)]
    public struct Penetration
    {
        public uint body_a;
        public uint vertex;
        public uint body_b;
        public PenetrationState state;
        /// <summary>index in vox_grid_get_contacts of the first contact of (body_a, vertex, body_b)</summary>
        public ulong contact;
        /// <summary>&gt;= 0, in the caller's unit</summary>
        public float depth;
        /// <summary>in the frame of the positions, out of body_b</summary>
        public Float3 direction;
    }

    /// <summary>`count` penetrations, `byte_stride` apart: one for each (body_a, vertex, body_b) that has contacts, in
    /// that order, unless one of them is a sensor (VOX_FILTER_SENSOR).</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct PenetrationView
    {
        public Penetration* data;
        public UIntPtr byte_stride;
        public ulong count;
        public ulong epoch;
    }

    /// <summary>Depth and direction of a vox_penetration as computed, in double; rounded to floats they are those of
    /// the vox_penetration.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 32)]
    public struct Depth
    {
        public double depth;
        public Double3 direction;
    }

    /// <summary>`count` depths, `byte_stride` apart.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct DepthView
    {
        public Depth* data;
        public UIntPtr byte_stride;
        public ulong count;
        public ulong epoch;
    }

    /// <summary>An edge of the surface of body_a and a face of the surface of body_b that have a point in common (a =
    /// b: self-contact; then they have no vertex in common).</summary>
    [StructLayout(LayoutKind.Sequential, Size = 128)]
    public struct EdgeContact
    {
        public uint body_a;
        /// <summary>vertices of body_a, the lower first</summary>
        public Uint2 edge;
        public uint body_b;
        /// <summary>vertices of body_b, the lowest first, counter-clockwise as seen from the side that the normal
        /// points to</summary>
        public Uint3 face;
        /// <summary>of body_b, behind the face; of doubled ones the lowest</summary>
        public uint tet;
        public CrossingKind kind;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>of the point, in [0, 1], with the sum 1 up to rounding</summary>
        public Double2 edge_weights;
        /// <summary>of the same point</summary>
        public Double3 face_weights;
        /// <summary>of the point, rounded</summary>
        public Double3 position;
        /// <summary>A unit vector out of `tet` or, if that is flat, to the side away from the lower vertex of the edge;
        /// 0, 0, 1 if the face has no area.</summary>
        public Double3 normal;
    }

    /// <summary>`count` edge contacts, `byte_stride` apart, sorted by body_a, edge, body_b and the three vertices of
    /// the face in ascending order.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct EdgeContactView
    {
        public EdgeContact* data;
        public UIntPtr byte_stride;
        public ulong count;
        public ulong epoch;
    }

    /// <summary>Vertex `vertex` of body_a is in no tetrahedron of body_b, but no further than the margin from its
    /// surface.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 88)]
    public struct MarginContact
    {
        public uint body_a;
        public uint vertex;
        /// <summary>never body_a</summary>
        public uint body_b;
        /// <summary>of body_b</summary>
        public uint tet;
        /// <summary>of the tetrahedron, as in vox_closest_hit</summary>
        public uint facet;
        /// <summary>its vertices, in the order given there</summary>
        public Uint3 face;
        /// <summary>of the closest point, in [0, 1], with the sum 1 up to rounding</summary>
        public Double3 face_weights;
        /// <summary>from the vertex to the closest point</summary>
        public double distance;
        /// <summary>a unit vector from the closest point to the vertex; out of the tetrahedron if there is no distance
        /// between them</summary>
        public Double3 normal;
    }

    /// <summary>`count` margin contacts, `byte_stride` apart, sorted by (body_a, vertex, body_b), each of which has one
    /// at most.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct MarginContactView
    {
        public MarginContact* data;
        public UIntPtr byte_stride;
        public ulong count;
        public ulong epoch;
    }

    /// <summary>Vertex `vertex` of body_a met the surface of body_b while both moved from their previous positions to
    /// the present ones (vox_mesh_bind_previous_positions; a mesh without previous positions stands still), wherever it
    /// was before and is after: also where it went through a thin mesh and out again.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 40)]
    public struct Passage
    {
        public uint body_a;
        public uint vertex;
        /// <summary>never body_a</summary>
        public uint body_b;
        /// <summary>of body_b</summary>
        public uint tet;
        /// <summary>of the tetrahedron, as in vox_closest_hit: the first that the vertex met; the lowest (tet, facet)
        /// of several at the same time</summary>
        public uint facet;
        /// <summary>its vertices, in the order given there</summary>
        public Uint3 face;
        /// <summary>in [0, 1], 0 at the previous positions: when it met it; never too late, and too early by no more
        /// than rounding errors make necessary</summary>
        public double time;
    }

    /// <summary>`count` passages, `byte_stride` apart, sorted by (body_a, vertex, body_b), each of which has one at
    /// most.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct PassageView
    {
        public Passage* data;
        public UIntPtr byte_stride;
        public ulong count;
        public ulong epoch;
    }

    /// <summary>Two meshes that touch: a vertex of one of them is in a tetrahedron of the other, or they have edge
    /// contacts (VOX_GRID_EDGE_CONTACTS). body_a &lt;= body_b; they are equal if a mesh touches itself.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 48)]
    public struct Pair
    {
        public uint body_a;
        public uint body_b;
        /// <summary>of body_a, as given at insertion</summary>
        public ulong user_data_a;
        public ulong user_data_b;
        public ulong first;
        public ulong a_in_b;
        public ulong b_in_a;
    }

    /// <summary>`count` pairs, `byte_stride` apart, sorted by (body_a, body_b).</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct PairView
    {
        public Pair* data;
        public UIntPtr byte_stride;
        public ulong count;
        public ulong epoch;
        public uint* contacts;
    }

    /// <summary>An event of a pair of meshes, body_a &lt;= body_b.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 32)]
    public struct TouchEvent
    {
        public uint body_a;
        public uint body_b;
        public ulong user_data_a;
        public ulong user_data_b;
        public Touch kind;
        /// <summary>index of the pair in vox_grid_get_pairs; VOX_NO_PAIR if it ended</summary>
        public uint pair;
    }

    /// <summary>All pairs that began, then all that persisted, then all that ended: `count` in total, `byte_stride`
    /// apart, each part sorted by (body_a, body_b).</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct TouchView
    {
        public TouchEvent* data;
        public UIntPtr byte_stride;
        public ulong count;
        public ulong epoch;
        public ulong began;
        public ulong persisted;
        public ulong ended;
    }

    /// <summary>Vertex `vertex` of body_a has entered body_b, or is in none of its tetrahedra any more.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 16)]
    public struct ContactEvent
    {
        public uint body_a;
        public uint vertex;
        public uint body_b;
        /// <summary>VOX_TOUCH_BEGAN or VOX_TOUCH_ENDED</summary>
        public Touch kind;
    }

    /// <summary>All vertices that entered, then all that left, each part sorted by (body_a, vertex, body_b).</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ContactEventView
    {
        public ContactEvent* data;
        public UIntPtr byte_stride;
        public ulong count;
        public ulong epoch;
        public ulong began;
        public ulong ended;
    }

    /// <summary>Geometry of one contact.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 168)]
    public struct Reading
    {
        /// <summary>index of the contact in vox_grid_get_contacts</summary>
        public ulong contact;
        /// <summary>vox_reading_flags, combined with |</summary>
        public ReadingFlags known;
        /// <summary>DEPTH: state, depth and direction of the vertex's vox_penetration</summary>
        public PenetrationState state;
        public float depth;
        public Float3 direction;
        /// <summary>POSITION: the vertex as it collides, in double and transformed</summary>
        public Double3 position;
        /// <summary>SURFACE (up to `triangle`): distance from the vertex to surface_position</summary>
        public double distance;
        /// <summary>the closest point of `triangle`</summary>
        public Double3 surface_position;
        /// <summary>its weights for the triangle's corners, in [0, 1], with the sum 1 up to rounding</summary>
        public Double3 barycentric;
        /// <summary>A unit vector out of the triangle's tetrahedron or, if that is flat, to the side away from the
        /// vertex.</summary>
        public Double3 normal;
        /// <summary>vertices of body_b, the lowest first, counter-clockwise as seen from the side that the normal
        /// points to</summary>
        public Uint3 triangle;
        public uint reserved;
        /// <summary>of body_a, as given at insertion</summary>
        public ulong user_data_a;
        public ulong user_data_b;
    }

    /// <summary>`count` readings, `byte_stride` apart, one for each contact or for each that was asked for, in the
    /// order of the contacts.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ReadingView
    {
        public Reading* data;
        public UIntPtr byte_stride;
        public ulong count;
        public ulong epoch;
    }

    /// <summary>What to read.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 24)]
    public struct ReadingsDesc
    {
        public uint struct_size;
        /// <summary>vox_reading_flags, combined with |; 0: all.</summary>
        public ReadingFlags what;
        /// <summary>VOX_NULL_BODY: all contacts; else those that vox_mesh_copy_contacts copies</summary>
        public uint body_a;
        /// <summary>VOX_NULL_BODY, or those that vox_pair_copy_contacts copies for body_a and it</summary>
        public uint body_b;
        /// <summary>Most searches for a closest point.</summary>
        public ulong closest_budget;
    }

    /// <summary>An allocator.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Allocator
    {
        public IntPtr allocate;
        public IntPtr release;
        public IntPtr user;
    }

    /// <summary>Receives one line of text (no newline), valid during the call only.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Log
    {
        public IntPtr write;
        public IntPtr user;
    }

    /// <summary>The caller's scheduler, designed as in Box3D.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct TaskSystem
    {
        public IntPtr enqueue;
        public IntPtr finish;
        public IntPtr user;
    }

    /// <summary>A count, or a time in nanoseconds.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Counter
    {
        /// <summary>static text, e.g. "candidates", or for a time "lookup_ns"</summary>
        public IntPtr name;
        public ulong value;
    }

    /// <summary>`count` counters.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CounterView
    {
        public Counter* data;
        public ulong count;
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
        /// <summary>not this body, e.g. the one that asks; an id that the locator does not have excludes none</summary>
        public uint excluded;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>vox_locator_find_closest: no further than this, in the caller's unit; 0: any distance</summary>
        public double max_distance;
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
        /// <summary>of the tetrahedron's corners, in [0, 1], each within 2^-41 of the true one</summary>
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

    /// <summary>How many nanoseconds one unit of each piece of work takes on a machine: what the models REFERENCE and
    /// FAST, and the reference engine, choose a cell size by.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 200)]
    public struct CostWeights
    {
        public uint struct_size;
        /// <summary>1: by vox_cost_calibrate</summary>
        public uint measured;
        /// <summary>in the library's own order, finite, &gt;= 0; 0: the one shipped with the library</summary>
        public Double24 ns;
    }

    /// <summary>The paper's engine (Sect. 3), for vox_grid_desc.reference.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ReferenceDesc
    {
        public uint struct_size;
        /// <summary>vox_reference_flags, combined with |</summary>
        public ReferenceFlags flags;
        /// <summary>buckets, at most VOX_MAX_VERTICES, raised to the next prime; 0: the first prime that is at least
        /// twice the number of vertices</summary>
        public ulong hash_table_size;
        /// <summary>DENSE: the box that has cells, min &lt; max on each axis.</summary>
        public Double3 world_min;
        /// <summary>the nearest cell.</summary>
        public Double3 world_max;
        /// <summary>copied; null: those shipped with the library</summary>
        public CostWeights* weights;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct SuggestDesc
    {
        public uint struct_size;
        public CostModel model;
        public SizeReading size_reading;
        public AreaReading area_reading;
        /// <summary>probability that a tet has no collision, in (0, 1); 0: 0.99</summary>
        public double p_nc;
        /// <summary>the paper's r: cost of a particle test divided by that of a cell visit; 0: 5</summary>
        public double cost_ratio;
        /// <summary>edge of the cubic world, for cells_per_axis; 0: longest side of the bounds</summary>
        public double world_edge;
        /// <summary>the zone is where predicted cost &lt;= (1 + zone_loss) * minimum; at most 1e6; 0: 0.05</summary>
        public double zone_loss;
        /// <summary>for rules.mean_edge_multiple (Gregory et al. 2000); 0: 2</summary>
        public double mean_edge_factor;
        /// <summary>for rules.resolution (McNeely et al. 1999): the required detail; 0: none</summary>
        public double resolution;
        /// <summary>REFERENCE with DENSE cells: most bytes that these may take; 0: no limit</summary>
        public ulong byte_budget;
        /// <summary>REFERENCE: vox_reference_flags, combined with |</summary>
        public uint reference_flags;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>REFERENCE and FAST; null: those shipped with the library</summary>
        public CostWeights* weights;
        /// <summary>of the call's memory; null: the C++ runtime's heap</summary>
        public Allocator* allocator;
    }

    /// <summary>Geometry of all meshes together, in the caller's unit.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 160)]
    public struct GeometryStats
    {
        public ulong vertices;
        public ulong tets;
        /// <summary>unique</summary>
        public ulong edges;
        /// <summary>unique triangles</summary>
        public ulong facets;
        /// <summary>facets of exactly one tet</summary>
        public ulong boundary_facets;
        /// <summary>of exactly zero volume</summary>
        public ulong degenerate_tets;
        public double mean_edge;
        public double mean_longest_edge;
        public double mean_box_side;
        /// <summary>median over tets of the longest side of the bounding box</summary>
        public double median_box_side;
        public double mean_facet_area;
        public double mean_tet_facet_area;
        public double mean_boundary_facet_area;
        /// <summary>mean over tets of |volume|</summary>
        public double mean_volume;
        /// <summary>of the vertices that tets use; of all vertices for a mesh without tets</summary>
        public Double3 bounds_min;
        public Double3 bounds_max;
    }

    /// <summary>Cell sizes that other rules would choose; 0 where a rule does not apply.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 48)]
    public struct CellSizeRules
    {
        /// <summary>Teschner et al. 2003</summary>
        public double mean_edge;
        /// <summary>Gregory et al. 2000: a constant times the mean edge</summary>
        public double mean_edge_multiple;
        /// <summary>Garcia-Alonso et al. 1994: 512 voxels in an object's box, mean over meshes whose box has a
        /// volume</summary>
        public double object_512;
        /// <summary>McNeely et al. 1999: the required resolution</summary>
        public double resolution;
        /// <summary>cube root of the mean tet volume (tried and rejected in Sect. 5)</summary>
        public double mean_volume;
        /// <summary>IPC Toolkit: median of the longest box sides</summary>
        public double median_box_side;
    }

    /// <summary>A point of a curve of costs.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 16)]
    public struct CostSample
    {
        public double cell_size;
        public double cost;
    }

    /// <summary>One term of a cost: a piece of work, how often it is done, and what that costs.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 48)]
    public struct CostShare
    {
        /// <summary>what is done, e.g. "visit a cell"; zero-terminated</summary>
        public Byte24 name;
        public double count;
        /// <summary>count times the weight</summary>
        public double cost;
        /// <summary>fraction of the whole cost, 0 to 1</summary>
        public double share;
    }

    /// <summary>A cell size and the reasons for it.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 1968)]
    public struct Suggestion
    {
        public uint struct_size;
        public CostModel model;
        public double cell_size;
        /// <summary>world edge / cell size, as the paper counts</summary>
        public double cells_per_axis;
        /// <summary>smallest and largest cell size of the zone</summary>
        public double zone_min;
        public double zone_max;
        /// <summary>at cell_size</summary>
        public double predicted_cost;
        public CellSizeRules rules;
        public GeometryStats stats;
        /// <summary>ascending in cell_size, evenly spaced in its logarithm</summary>
        public CostSample64 curve;
        public uint curve_count;
        public uint term_count;
        /// <summary>at cell_size; their costs add up to predicted_cost</summary>
        public CostShare12 terms;
        /// <summary>predicted cost at the cell size of each rule; 0 if the rule does not apply</summary>
        public CellSizeRules rule_costs;
        /// <summary>smallest cell size within the byte budget; 0: the budget does not limit it</summary>
        public double budget_cell_size;
        /// <summary>REFERENCE: the loss of using one cell size for tetrahedra of all sizes.</summary>
        public double uniform_loss;
        /// <summary>level_count cell sizes, that of the smallest tets first</summary>
        public Double4 levels;
        public uint level_count;
        public uint reserved;
    }

    /// <summary>The least cost, and where it is.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 1064)]
    public struct CostMinimum
    {
        public uint struct_size;
        public uint curve_count;
        public double cell_size;
        public double cost;
        /// <summary>the range around cell_size, within [min, max], where the cost is at most (1 + zone_loss) times the
        /// least</summary>
        public double zone_min;
        public double zone_max;
        /// <summary>from min to max, evenly spaced in the logarithm</summary>
        public CostSample64 curve;
    }

    /// <summary>Primitives: each is a few vertices.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Primitives
    {
        public uint struct_size;
        public PrimitiveType type;
        /// <summary>of vertices</summary>
        public Positions positions;
        /// <summary>The vertices of each primitive: two numbers an edge or a box, three a triangle, four a tetrahedron,
        /// one a point.</summary>
        public uint* indices;
        /// <summary>from one primitive to the next; 0: tightly packed</summary>
        public ulong index_byte_stride;
        /// <summary>primitives, at most 2^32 - 1</summary>
        public ulong count;
        /// <summary>one number of each primitive, &gt;= 0; null: 0</summary>
        public IntPtr radii;
        /// <summary>0: tightly packed</summary>
        public ulong radius_byte_stride;
        public Format radius_format;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>of all primitives, added to their own, &gt;= 0</summary>
        public double radius;
    }

    /// <summary>What a run of a grid does at one cell size.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 48)]
    public struct GridWork
    {
        /// <summary>primitives put into a cell</summary>
        public double entries;
        /// <summary>cells looked at; with PAIRS, those that hold something</summary>
        public double visits;
        /// <summary>visits of a cell that holds nothing</summary>
        public double empty;
        /// <summary>entries of the cells looked at; with PAIRS, pairs in a cell</summary>
        public double reads;
        /// <summary>cells that hold something</summary>
        public double occupied;
        /// <summary>of the box of all that is held: cells of a dense grid</summary>
        public double cells;
    }

    /// <summary>Nanoseconds for one of each, &gt;= 0.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 56)]
    public struct GridWeights
    {
        /// <summary>a run, whatever the cell size</summary>
        public double @fixed;
        public double entries;
        public double visits;
        /// <summary>what a visit of a cell that holds something takes more than one of an empty cell</summary>
        public double found;
        public double reads;
        /// <summary>making and forgetting a cell</summary>
        public double occupied;
        /// <summary>for grids with dense storage: clearing one</summary>
        public double cells;
    }

    /// <summary>A uniform grid that is not this library's.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ForeignGrid
    {
        public uint struct_size;
        /// <summary>vox_foreign_flags, combined with |</summary>
        public ForeignFlags flags;
        public CellContent content;
        public CellLook look;
        /// <summary>what is put into cells</summary>
        public Primitives* held;
        /// <summary>null: those held ask themselves, each of all, itself included</summary>
        public Primitives* asking;
        /// <summary>boxes that ask are larger by this on all sides, &gt;= 0.</summary>
        public double radius;
        /// <summary>The smallest cell size that gives right answers. 0: with AROUND, half the longest side of a box
        /// held, and half that of one that asks with its radius; otherwise none.</summary>
        public double least_cell_size;
        /// <summary>as vox_suggest_desc.zone_loss</summary>
        public double zone_loss;
        /// <summary>whose weights are used where `weights` are all 0</summary>
        public KnownGrid known;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>all 0: those of `known`</summary>
        public GridWeights weights;
        /// <summary>of the call's memory; null: the C++ runtime's heap</summary>
        public Allocator* allocator;
    }

    /// <summary>Cell sizes that other rules would choose; 0 where a rule does not apply.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 40)]
    public struct ForeignRules
    {
        /// <summary>mean length of the edges of the primitives held, shared ones counted each time</summary>
        public double mean_edge;
        /// <summary>mean of the longest sides of their boxes</summary>
        public double mean_box_side;
        /// <summary>median of these</summary>
        public double median_box_side;
        /// <summary>cube root of the volume of the box of all, over their number</summary>
        public double spacing;
        /// <summary>mean radius of those that ask</summary>
        public double radius;
    }

    /// <summary>A cell size for a foreign grid, and the reasons for it.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 2104)]
    public struct ForeignSuggestion
    {
        public uint struct_size;
        /// <summary>vox_foreign_warnings</summary>
        public ForeignWarnings warnings;
        public double cell_size;
        /// <summary>as in vox_suggestion, and not below least_cell_size</summary>
        public double zone_min;
        public double zone_max;
        /// <summary>at cell_size</summary>
        public double predicted_cost;
        /// <summary>the smallest legal size; 0: any</summary>
        public double least_cell_size;
        /// <summary>at cell_size</summary>
        public GridWork work;
        /// <summary>that were used</summary>
        public GridWeights weights;
        public ForeignRules rules;
        /// <summary>predicted cost at the cell size of each rule; 0 if it does not apply, or that size is too small for
        /// vox_count_for</summary>
        public ForeignRules rule_costs;
        /// <summary>ascending in cell_size, evenly spaced in its logarithm</summary>
        public CostSample64 curve;
        public uint curve_count;
        public uint term_count;
        /// <summary>at cell_size; their costs add up to predicted_cost</summary>
        public CostShare12 terms;
        /// <summary>whose size it is</summary>
        public ForeignRule rule;
        public uint reserved;
        /// <summary>zero-terminated; "" if there is no warning</summary>
        public Byte256 note;
    }

    /// <summary>One timing of a grid: a run at this cell size took so long.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 16)]
    public struct GridTiming
    {
        /// <summary>&gt; 0</summary>
        public double cell_size;
        /// <summary>1e-30 to 1e30</summary>
        public double seconds;
    }

    /// <summary>Weights from timings, and the cell size they lead to.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 1392)]
    public struct GridFit
    {
        public uint struct_size;
        /// <summary>vox_foreign_warnings</summary>
        public ForeignWarnings warnings;
        /// <summary>&gt;= 0; the best fit to the timings.</summary>
        public GridWeights weights;
        /// <summary>root mean square of (fitted time / measured time - 1) over the timings</summary>
        public double residual;
        public double cell_size;
        public double zone_min;
        public double zone_max;
        /// <summary>at cell_size</summary>
        public double predicted_seconds;
        /// <summary>in seconds</summary>
        public CostSample64 curve;
        public uint curve_count;
        public uint reserved;
        public Byte256 note;
    }

    /// <summary>How to tune; all 0 by default.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 48)]
    public struct TuneDesc
    {
        public uint struct_size;
        /// <summary>3 to VOX_TUNE_RUN_CAPACITY; 0: 7</summary>
        public uint most_runs;
        /// <summary>cell sizes to try, 0 &lt; min &lt;= max; both 0: an eighth to eight times the first</summary>
        public double min;
        public double max;
        /// <summary>the cell size to begin with; 0: what vox_suggest_for says.</summary>
        public double first;
        /// <summary>as vox_suggest_desc.zone_loss</summary>
        public double zone_loss;
        /// <summary>stops where the cell size is within this of the best one, as far as it can tell; 0: 0.02</summary>
        public double wanted_loss;
    }

    /// <summary>What tuning found.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 1912)]
    public struct Tuning
    {
        public uint struct_size;
        /// <summary>vox_foreign_warnings</summary>
        public ForeignWarnings warnings;
        public double cell_size;
        public double zone_min;
        public double zone_max;
        /// <summary>of a run at cell_size, as fitted</summary>
        public double seconds;
        /// <summary>how much longer a run may take than at the best cell size, as far as it can tell: 0.03 for 3
        /// %.</summary>
        public double expected_loss;
        /// <summary>relative: how far timings are from the fitted curve, root mean square</summary>
        public double noise;
        /// <summary>as in vox_grid_fit; all 0 where there is no grid</summary>
        public GridWeights weights;
        /// <summary>run_count runs, in order; seconds may be infinite</summary>
        public GridTiming32 runs;
        public uint run_count;
        public uint curve_count;
        /// <summary>in seconds</summary>
        public CostSample64 curve;
        public Byte256 note;
    }

    /// <summary>What a surface is made of.</summary>
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
        /// <summary>2 * edge_count indices of vertices, copied.</summary>
        public uint* edges;
        /// <summary>3 * face_count indices of vertices, copied</summary>
        public uint* faces;
        /// <summary>The patch of each vertex, below patch_count, copied; null: all vertices are in one patch.</summary>
        public uint* patches;
        /// <summary>copied; null: 1 each</summary>
        public ulong* patch_categories;
        /// <summary>copied; null: all bits</summary>
        public ulong* patch_masks;
        public ulong patch_count;
        /// <summary>Edge length of a cell of the grid in which pairs are looked for. 0: chosen at every motion by the
        /// cost model.</summary>
        public double cell_size;
        /// <summary>Most bytes the surface may hold at any time, its answers included.</summary>
        public ulong byte_budget;
        /// <summary>copied; null: the C++ runtime's heap</summary>
        public Allocator* allocator;
        /// <summary>Copied; null: the built-in scheduler.</summary>
        public TaskSystem* tasks;
    }

    /// <summary>The vertices of the edges or faces of a surface.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct FeatureView
    {
        public uint struct_size;
        /// <summary>2 of an edge, 3 of a face</summary>
        public uint vertices_each;
        /// <summary>edges or faces</summary>
        public ulong count;
        /// <summary>vertices_each * count numbers</summary>
        public uint* vertices;
    }

    /// <summary>Positions of all vertices of a surface, or two, between which each vertex moves along a straight line
    /// at constant speed.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Motion
    {
        public uint struct_size;
        /// <summary>vox_motion_flags, combined with |</summary>
        public MotionFlags flags;
        /// <summary>at time 0, copied; as many as the surface has vertices</summary>
        public Positions from;
        /// <summary>at time 1, copied, in the same format; none: everything stands still</summary>
        public Positions to;
        /// <summary>The box of a vertex holds both its positions and reaches further by this on each side, rounded
        /// outward: to the next number of their format below and above.</summary>
        public double radius;
    }

    /// <summary>The partners of features [first, first + count): those of feature first + i are partners[offsets[i]] to
    /// partners[offsets[i + 1] - 1], ascending.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct PairLists
    {
        public uint struct_size;
        /// <summary>0</summary>
        public uint reserved;
        public ulong first;
        /// <summary>features answered; where there is a byte budget they may be fewer than asked</summary>
        public ulong count;
        /// <summary>offsets[count]</summary>
        public ulong pair_count;
        /// <summary>count + 1 numbers</summary>
        public ulong* offsets;
        /// <summary>pair_count numbers</summary>
        public uint* partners;
    }

    /// <summary>What the last search for pairs did, also one by vox_surface_find_crossings and the like, and what the
    /// surface holds.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 72)]
    public struct PairCounters
    {
        public uint struct_size;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>that was used; 0 where no grid was needed</summary>
        public double cell_size;
        /// <summary>with something in them; those that share a place in the hash table count once</summary>
        public ulong cells;
        /// <summary>tiles (at most 64 features each) whose boxes overlap those of tiles of the other kind</summary>
        public ulong tile_pairs;
        /// <summary>features compared with the 64 of a tile at once</summary>
        public ulong boxes_compared;
        /// <summary>pairs whose boxes overlap, before VOX_MOTION_CULL</summary>
        public ulong overlaps;
        /// <summary>of these, left out by VOX_MOTION_CULL</summary>
        public ulong culled;
        /// <summary>held now</summary>
        public ulong bytes;
        public ulong peak_bytes;
    }

    /// <summary>An edge and a face that have a point in common.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 80)]
    public struct Crossing
    {
        public uint edge;
        public uint face;
        /// <summary>of vox.h</summary>
        public CrossingKind kind;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>of a common point; they add up to 1</summary>
        public Double2 edge_weights;
        /// <summary>of the same point</summary>
        public Double3 face_weights;
        /// <summary>of the point, rounded</summary>
        public Double3 position;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CrossingView
    {
        public uint struct_size;
        /// <summary>from one element to the next</summary>
        public uint byte_stride;
        public ulong count;
        /// <summary>by edge, then face</summary>
        public Crossing* crossings;
    }

    /// <summary>Two features and their closest points.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 112)]
    public struct ClosePair
    {
        public uint a;
        public uint b;
        public double distance;
        /// <summary>of the closest point on a: one for each of its vertices, then 0</summary>
        public Double3 weights_a;
        public Double3 weights_b;
        /// <summary>the closest points, rounded</summary>
        public Double3 point_a;
        public Double3 point_b;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct CloseView
    {
        public uint struct_size;
        /// <summary>from one element to the next</summary>
        public uint byte_stride;
        public ulong count;
        /// <summary>by a, then b</summary>
        public ClosePair* pairs;
    }

    /// <summary>How the time of contact is computed.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 24)]
    public struct ContactTimeDesc
    {
        public uint struct_size;
        /// <summary>of one pair; 0: 10000.</summary>
        public uint most_iterations;
        /// <summary>contact is where two features come this close, &gt;= 0</summary>
        public double distance;
        /// <summary>At the time given, the features are still further apart than `distance` by at most this part of
        /// what it was at time 0; below 1; 0: 0.1.</summary>
        public double slack;
    }

    /// <summary>A safe part of the motion, and the pair that ends it.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 48)]
    public struct SafeStep
    {
        public uint struct_size;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>in [0, 1]: up to this time no two features touch. 1: not within the motion</summary>
        public double step;
        /// <summary>that were examined</summary>
        public ulong pairs;
        /// <summary>1: the time of the pair below was given up after most_iterations; else 0</summary>
        public ulong unfinished;
        /// <summary>the pair with the first time of contact, where step is below 1: FACE and VERTEX, or EDGE
        /// and</summary>
        public Feature kind_a;
        /// <summary>EDGE.</summary>
        public Feature kind_b;
        public uint a;
        public uint b;
    }

    /// <summary>Two features that come into contact, and when at the earliest.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 16)]
    public struct TimedPair
    {
        public uint a;
        public uint b;
        /// <summary>in [0, 1], not later than the exact one; earlier where it was given up after
        /// most_iterations</summary>
        public double time;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct TimedView
    {
        public uint struct_size;
        /// <summary>from one element to the next</summary>
        public uint byte_stride;
        public ulong count;
        /// <summary>by a, then b</summary>
        public TimedPair* pairs;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct IoLoadDesc
    {
        public uint struct_size;
        public IoFormat format;
        /// <summary>which mesh of a scene file to take, from 1; 0: all, joined</summary>
        public uint mesh;
        /// <summary>0</summary>
        public uint reserved;
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
        /// <summary>those of the file</summary>
        public uint* triangles;
        public ulong triangle_count;
    }

    /// <summary>What was read, what was left out, and what is odd about the mesh.</summary>
    [StructLayout(LayoutKind.Sequential, Size = 208)]
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

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct SimDesc
    {
        public uint struct_size;
        /// <summary>Substeps of a step, 1 to 10000; default 10.</summary>
        public uint substeps;
        /// <summary>Contacts are detected before the first substep of a step and after every `detect_every` substeps of
        /// it. 1 (the default): in every substep; the number of substeps or more: once a step; 0: never, so that bodies
        /// pass through each other.</summary>
        public uint detect_every;
        /// <summary>0</summary>
        public uint reserved;
        /// <summary>acceleration; default 0, 0, -9.81</summary>
        public Double3 gravity;
        /// <summary>a longer step is clamped to this, with a log line; 1e-12 to 1e12, default 1/30</summary>
        public double max_time_step;
        /// <summary>The floor keeps particles where floor_normal . x &gt;= floor_offset.</summary>
        public Double3 floor_normal;
        public double floor_offset;
        /// <summary>Coulomb's coefficient, between bodies and with the floor; &gt;= 0, default 0.5</summary>
        public double friction;
        /// <summary>A penetrating vertex is pushed out by a force of depth / contact_compliance along the direction of
        /// the depth stage, integrated implicitly, so that any stiffness is stable. &gt;= 0; 0 (the default): the
        /// greatest stiffness that a substep can handle.</summary>
        public double contact_compliance;
        /// <summary>greatest speed at which earlier penetrations are undone, &gt;= 0; default 1.</summary>
        public double max_push_speed;
        /// <summary>penetration depth that is tolerated, so that resting contacts persist.</summary>
        public double contact_slop;
        /// <summary>settings of the grid inside, read during create; null: defaults</summary>
        public GridDesc* grid;
        /// <summary>of the simulation, copied; the grid has one of its own in its desc</summary>
        public Log* log;
        /// <summary>Where the simulation and its bodies live, as does its grid unless `grid` names another
        /// allocator.</summary>
        public Allocator* allocator;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct SimBodyDesc
    {
        public uint struct_size;
        /// <summary>vox_sim_body_flags, combined with |</summary>
        public SimBodyFlags flags;
        /// <summary>within 1e15 of the origin on each axis</summary>
        public double* positions;
        /// <summary>The undeformed shape; null (the default): `positions`.</summary>
        public double* rest_positions;
        /// <summary>null (the default): at rest</summary>
        public double* velocities;
        /// <summary>both windings are accepted</summary>
        public uint* tets;
        public ulong vertex_count;
        /// <summary>at least 1</summary>
        public ulong tet_count;
        /// <summary>mass per rest volume, &gt; 0; default 1000.</summary>
        public double density;
        /// <summary>Resistance to stretching.</summary>
        public double youngs_modulus;
        /// <summary>resistance to change of volume, beyond that of the edges; &gt;= 0, default 1e6</summary>
        public double bulk_modulus;
        /// <summary>a time: edges resist the rate of their strain with damping times their stiffness; &gt;= 0, default
        /// 0.01</summary>
        public double damping;
        /// <summary>returned by vox_body_get_user_data on the sim's grid</summary>
        public ulong user_data;
    }

    /// <summary>Arrays of a body with its state after the last step.</summary>
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct SimBodyView
    {
        public double* positions;
        public double* velocities;
        public double* masses;
        /// <summary>`positions` rounded to float, which the grid borrows.</summary>
        public float* grid_positions;
        public uint* tets;
        public ulong vertex_count;
        public ulong tet_count;
    }

    [StructLayout(LayoutKind.Sequential, Size = 96)]
    public struct SimEnergies
    {
        public uint struct_size;
        public uint reserved;
        public double kinetic;
        /// <summary>energy in gravity, 0 at the origin</summary>
        public double potential;
        /// <summary>energy of edges and volumes</summary>
        public double elastic;
        public double mass;
        public Double3 momentum;
        /// <summary>centre of mass</summary>
        public Double3 centre;
        /// <summary>speed of the fastest particle</summary>
        public double max_speed;
    }

    [StructLayout(LayoutKind.Sequential, Size = 144)]
    public struct SimCounts
    {
        public uint struct_size;
        public uint bodies;
        public ulong vertices;
        public ulong tets;
        /// <summary>edge constraints</summary>
        public ulong edges;
        /// <summary>volume constraints</summary>
        public ulong volumes;
        /// <summary>tets of zero rest volume</summary>
        public ulong flat_tets;
        /// <summary>tets of negative rest volume</summary>
        public ulong inverted_tets;
        /// <summary>vertices that would have been lighter than a hundredth of the body's mean</summary>
        public ulong raised_masses;
        /// <summary>constraints that were softened, as the last step's substeps cannot handle their stiffness</summary>
        public ulong softened;
        /// <summary>total since the creation, like the next three</summary>
        public ulong steps;
        public ulong substeps;
        public ulong detections;
        /// <summary>steps that were clamped to max_time_step</summary>
        public ulong clamped_steps;
        /// <summary>penetrations of the last detection</summary>
        public ulong penetrations;
        /// <summary>particles that the floor held in the last substep</summary>
        public ulong floor_contacts;
        /// <summary>nanoseconds of the last step</summary>
        public ulong step_ns;
        /// <summary>its part in vox_grid_step</summary>
        public ulong detect_ns;
        /// <summary>the rest of it</summary>
        public ulong solve_ns;
    }

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate void Task(ulong begin, ulong end, uint worker, IntPtr context);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate double CostFunction(double cell_size, IntPtr user);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    internal delegate double GridRun(double cell_size, IntPtr user);

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
        /// <summary>Version of the stable interface.</summary>
        internal const uint VOX_ABI_VERSION = 1;
        /// <summary>as a worker_count: one worker per core</summary>
        internal const uint VOX_ALL_CORES = 4294967295;
        /// <summary>as an index: none</summary>
        internal const uint VOX_NONE = 4294967295;
        /// <summary>per grid, at one time, including retired slots</summary>
        internal const uint VOX_MAX_BODIES = 1048576;
        /// <summary>uses of one mesh slot before it is retired</summary>
        internal const uint VOX_MAX_GENERATIONS = 4095;
        /// <summary>per grid</summary>
        internal const uint VOX_MAX_VERTICES = 2147483647;
        /// <summary>per grid</summary>
        internal const uint VOX_MAX_TETS = 2147483647;
        /// <summary>workers of a grid</summary>
        internal const uint VOX_MAX_WORKERS = 256;
        /// <summary>names no mesh</summary>
        internal const uint VOX_NULL_BODY = 0;
        /// <summary>vox_filter.self_rings</summary>
        internal const uint VOX_MAX_RINGS = 8;
        /// <summary>vox_failure.vertex where a failure is not about a vertex</summary>
        internal const uint VOX_NO_VERTEX = 4294967295;
        /// <summary>contacts of one step; a step with more fails with VOX_ERROR_LIMIT</summary>
        internal const uint VOX_MAX_CONTACTS = 4294967295;
        /// <summary>vox_touch_event.pair of a pair that ended</summary>
        internal const uint VOX_NO_PAIR = 4294967295;
        /// <summary>tasks enqueued in one step</summary>
        internal const uint VOX_MAX_TASKS = 64;
        /// <summary>numbers of vox_cost_weights</summary>
        internal const uint VOX_COST_WEIGHT_CAPACITY = 24;
        /// <summary>most samples of a curve</summary>
        internal const uint VOX_COST_CURVE_CAPACITY = 64;
        /// <summary>most terms of a cost, in any model</summary>
        internal const uint VOX_COST_TERM_CAPACITY = 12;
        /// <summary>most entries of vox_suggestion.levels</summary>
        internal const uint VOX_CELL_SIZE_LEVEL_CAPACITY = 4;
        /// <summary>bytes of a note, its zero included</summary>
        internal const uint VOX_NOTE_CAPACITY = 256;
        /// <summary>most runs of vox_cost_tune</summary>
        internal const uint VOX_TUNE_RUN_CAPACITY = 32;
        /// <summary>vertices, edges or faces of a surface; each.</summary>
        internal const uint VOX_MAX_FEATURES = 2147483647;
        /// <summary>patches of a surface.</summary>
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

        /// <summary>Name of a result code, e.g. "VOX_ERROR_BUDGET".</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern IntPtr vox_result_string(Result result);

        /// <summary>The text of this thread's last failure, e.g. "tet 17 names vertex 900 of 812", or "" if nothing has
        /// failed yet.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern IntPtr vox_last_error();

        /// <summary>Sets this thread's vox_last_error() text and returns `result`, so that libraries built on vox
        /// (vox_io among them) can report failures the same way.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_fail(Result result, IntPtr text);

        /// <summary>Version of the library that is running: major * 1000000 + minor * 1000 + patch.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern uint vox_version();

        /// <summary>VOX_ABI_VERSION of the library that is running.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern uint vox_abi_version();

        /// <summary>"vox", the version, compiler, language level, instruction sets, built-in scheduler and options of
        /// this build, in one line.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern IntPtr vox_build_info();

        /// <summary>Creates a grid. desc null: all defaults.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_create(GridDesc* desc, IntPtr* out_grid);

        /// <summary>Destroys a grid and releases all its memory.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern void vox_grid_destroy(IntPtr grid);

        /// <summary>Removes all meshes and contacts and keeps the settings.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_clear(IntPtr grid);

        /// <summary>Allocates memory for what a grid keeps of that many meshes and contacts beside the meshes
        /// themselves, in advance; never releases any.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_reserve(IntPtr grid, uint mesh_count, ulong contact_count);

        /// <summary>Sets the cell size of the following steps; 0: the library chooses.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_set_cell_size(IntPtr grid, double cell_size);

        /// <summary>Sets vox_grid_desc.worker_count for the following steps.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_set_worker_count(IntPtr grid, uint worker_count);

        /// <summary>Sets vox_grid_desc.flags (all of them) for the following steps.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_set_flags(IntPtr grid, GridFlags flags);

        /// <summary>From the next step on, also find the vertices of other meshes that are outside of the tetrahedra of
        /// a mesh, but within `margin` (in the caller's unit) of its surface: vox_grid_margin_contacts. 0 (the
        /// default): none, at no cost, and the memory that this took is released.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_set_margin(IntPtr grid, double margin);

        /// <summary>Gets a grid's state.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_info(IntPtr grid, GridInfo* out_info);

        /// <summary>Adds a mesh, which takes part from the next step on.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_insert(IntPtr grid, MeshDesc* desc, uint* out_body);

        /// <summary>Removes a mesh.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_remove(IntPtr grid, uint body);

        /// <summary>1 when `mesh` names a mesh of the grid, else 0 (also for a null grid).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern uint vox_body_is_valid(IntPtr grid, uint body);

        /// <summary>The user_data the mesh was inserted with.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_get_user_data(IntPtr grid, uint body, ulong* out_user_data);

        /// <summary>Copies the ids of the first `capacity` meshes of the grid, disabled ones included,
        /// ascending.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_bodies(IntPtr grid, uint* bodies, ulong capacity, ulong* out_count);

        /// <summary>Writes the fields that out_info-&gt;struct_size covers (set it first).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_get_info(IntPtr grid, uint body, BodyInfo* out_info);

        /// <summary>Copies the first `capacity` tetrahedra of a mesh: of tetrahedron t the corners, as they were given,
        /// to corners[4 * t] to corners[4 * t + 3], and to enabled[t] 1 or, if it is disabled or removed, 0.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_get_tets(IntPtr grid, uint body, uint* corners, byte* enabled, ulong
            capacity, ulong* out_count);

        /// <summary>Makes a mesh borrow another array of positions, one for each vertex, under the rule of
        /// vox_mesh_desc.positions, and releases one that it owned.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_bind_positions(IntPtr grid, uint body, Positions* positions);

        /// <summary>Borrows the positions that the vertices of a mesh had before they moved to those of
        /// vox_mesh_bind_positions: in the following steps each vertex moves from one to the other in a straight line,
        /// at constant speed, and such steps also find vox_grid_passages.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_bind_previous_positions(IntPtr grid, uint body, Positions* positions);

        /// <summary>Makes the next step process a mesh even if it is at rest (see vox_grid_step).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_mark_moved(IntPtr grid, uint body);

        /// <summary>Sets what the mesh collides with, from the next step on (the filter is copied).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_set_filter(IntPtr grid, uint body, Filter* filter);

        /// <summary>Disables a mesh (enabled 0), so that it takes no part in the following steps and its positions are
        /// not read, or enables it again (1, as at insertion).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_set_enabled(IntPtr grid, uint body, uint enabled);

        /// <summary>With enabled 0, the two meshes do not collide in the following steps, whatever their filters say;
        /// with 1, their filters decide.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_set_pair_enabled(IntPtr grid, uint body_a, uint body_b, uint enabled);

        /// <summary>Gives the mesh positions of its own that the caller may write to: one for each vertex, packed, in
        /// the format it was inserted with or bound to last.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_map_positions(IntPtr grid, uint body, IntPtr* out_positions);

        /// <summary>Moves a mesh as a whole.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_body_set_transform(IntPtr grid, uint body, double* matrix);

        /// <summary>Replaces tetrahedra, vertices and positions, as if the mesh had been inserted with those of
        /// `desc`.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_set_topology(IntPtr grid, uint body, MeshDesc* desc);

        /// <summary>Disables the `count` tetrahedra named by `tets` (enabled 0), so that they contain no vertex and
        /// have no edges and facets, or enables them again (1, as at insertion).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_set_tets_enabled(IntPtr grid, uint body, uint* tets, ulong count, uint
            enabled);

        /// <summary>Gives tetrahedron tets[i] the corners corners[4 * i] to corners[4 * i + 3], copied, for each i
        /// below count.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_replace_tets(IntPtr grid, uint body, uint* tets, ulong count, uint*
            corners);

        /// <summary>Adds `count` tetrahedra with 4 corners each, copied.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_append_tets(IntPtr grid, uint body, uint* corners, ulong count, uint*
            out_first);

        /// <summary>Removes tetrahedra, disabled ones included.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_remove_tets(IntPtr grid, uint body, uint* tets, ulong count);

        /// <summary>Adds vertices, which belong to no tetrahedron yet.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_append_vertices(IntPtr grid, uint body, VerticesDesc* desc, uint*
            out_first);

        /// <summary>Removes vertices; a vertex of an enabled tetrahedron is an INVALID_ARGUMENT.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_remove_vertices(IntPtr grid, uint body, uint* vertices, ulong count);

        /// <summary>Finds all contacts of the positions as they are now.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_step(IntPtr grid);

        /// <summary>Steps `count` grids, which must differ, each as by vox_grid_step, several at the same time: for
        /// many small scenes that have nothing to do with each other.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grids_step(IntPtr* grids, ulong count, TaskSystem* tasks, uint worker_count,
            Result* results);

        /// <summary>The mesh that made the last step fail (index 0), or the meshes that it left out
        /// (VOX_GRID_SKIP_BAD_BODIES): the index-th of them, in the order of ids.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_failure(IntPtr grid, uint index, Failure* out_failure);

        /// <summary>The contacts of the last step; count 0 before the first, after a failed one and after a
        /// clear.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_contacts(IntPtr grid, ContactView* out_view);

        /// <summary>The contacts of `count` grids, one grid after the other: those of grid i begin at index offsets[i]
        /// and end before offsets[i + 1], where offsets has count + 1 numbers, all of which are written.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grids_copy_contacts(IntPtr* grids, ulong count, Contact* contacts, ulong
            capacity, ulong* offsets);

        /// <summary>A hash of the contacts: all fields, in order.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_hash(IntPtr grid, ulong* out_hash);

        /// <summary>The penetrations of the last step; count 0 if it found no contacts, before the first step, after a
        /// failed one and after a clear.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_penetrations(IntPtr grid, PenetrationView* out_view);

        /// <summary>The depths of vox_grid_penetrations, one for each, in that order.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_depths(IntPtr grid, DepthView* out_view);

        /// <summary>The edge contacts of the last step: the same for every engine, cell size and number of
        /// workers.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_edge_contacts(IntPtr grid, EdgeContactView* out_view);

        /// <summary>A hash of the edge contacts: all fields, in order.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_edge_hash(IntPtr grid, ulong* out_hash);

        /// <summary>Computes the way out for every edge contact of the last step (vox_grid_edge_depths).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_prepare_edge_depths(IntPtr grid);

        /// <summary>The depth and direction of each edge contact, in the order of vox_grid_edge_contacts.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_edge_depths(IntPtr grid, DepthView* out_view);

        /// <summary>The margin contacts of the last step: the same for every engine, cell size and number of
        /// workers.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_margin_contacts(IntPtr grid, MarginContactView* out_view);

        /// <summary>The passages of the last step, between meshes of which one has previous positions: the same for
        /// every engine, cell size and number of workers.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_passages(IntPtr grid, PassageView* out_view);

        /// <summary>The pairs that touched in the last step; count 0 before the first, after a failed one and after a
        /// clear.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_pairs(IntPtr grid, PairView* out_view);

        /// <summary>Copies the first `capacity` of the last step's contacts in which `mesh` is body_a or body_b, pair
        /// by pair, in the order of vox_grid_get_pairs.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_copy_contacts(IntPtr grid, uint body, Contact* contacts, ulong capacity,
            ulong* out_count);

        /// <summary>The same for the contacts between two meshes, given in either order, or of one mesh with itself
        /// (body_a = body_b): the contacts of their vox_pair.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_pair_copy_contacts(IntPtr grid, uint body_a, uint body_b, Contact* contacts,
            ulong capacity, ulong* out_count);

        /// <summary>What the last step changed; count 0 before the first one.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_touch_events(IntPtr grid, TouchView* out_view);

        /// <summary>The same for single vertices, under the same rules.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_contact_events(IntPtr grid, ContactEventView* out_view);

        /// <summary>Computes the readings of the last step's contacts from the meshes as they are now, so borrowed
        /// positions must still be those of the step. vox_reading.known shows what is missing because it was removed or
        /// changed since.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_prepare_readings(IntPtr grid);

        /// <summary>As vox_grid_prepare_readings, which is the same with desc null, but computes only the parts
        /// desc-&gt;what of the readings of some contacts.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_prepare_readings_of(IntPtr grid, ReadingsDesc* desc);

        /// <summary>The prepared readings.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_readings(IntPtr grid, ReadingView* out_view);

        /// <summary>Depth and direction of the prepared readings in double, one for each, in that order; zero where
        /// vox_reading.known lacks VOX_READING_DEPTH.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_reading_depths(IntPtr grid, DepthView* out_view);

        /// <summary>As vox_mesh_copy_contacts, but copies the prepared readings of those contacts, in the same
        /// order.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_mesh_copy_readings(IntPtr grid, uint body, Reading* readings, ulong capacity,
            ulong* out_count);

        /// <summary>As vox_pair_copy_contacts, but copies the prepared readings of those contacts, in the same
        /// order.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_pair_copy_readings(IntPtr grid, uint body_a, uint body_b, Reading* readings,
            ulong capacity, ulong* out_count);

        /// <summary>Writes the grid as it is now to `bytes`, in a format that is the same on every machine
        /// (docs/snapshot.md): settings, meshes with their ids, positions (borrowed ones too, read during the call),
        /// and the state that the next events are derived from.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_save(IntPtr grid, IntPtr bytes, ulong capacity, ulong* out_size);

        /// <summary>Creates a grid from a snapshot.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_load(IntPtr bytes, ulong size, GridDesc* desc, IntPtr* out_grid);

        /// <summary>What the last successful step did, and how long each stage of it took: all 0 before the first.
        /// docs/engine.md lists the names; what programs act on is in vox_grid_info.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_get_counters(IntPtr grid, CounterView* out_view);

        /// <summary>Takes a locator of the grid as it is now, and releases the one that *locator held before, if
        /// any.</summary>
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

        /// <summary>The cell size that minimises the cost model for these meshes (their positions as they are now).
        /// desc null: defaults.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_suggest_cell_size(SuggestDesc* desc, MeshDesc* meshes, ulong mesh_count,
            Suggestion* @out);

        /// <summary>The same for the meshes of a grid.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_grid_suggest_cell_size(IntPtr grid, SuggestDesc* desc, Suggestion* @out);

        /// <summary>Measures this machine's weights by steps of both engines over a small built-in scene, in about ten
        /// milliseconds.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_cost_calibrate(CostWeights* @out);

        /// <summary>Finds the cell size between min and max with the least cost: a scan that is even in the logarithm
        /// of the cell size, then a golden-section search around its best point.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_cost_minimise(IntPtr cost, IntPtr user, double min, double max, double
            zone_loss, CostMinimum* @out);

        /// <summary>Sets what is known of a grid that people have: content, look, flags, known, weights.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_foreign_grid_set_known(ForeignGrid* grid, KnownGrid known);

        /// <summary>The cell size that costs this grid least.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_suggest_for(ForeignGrid* grid, ForeignSuggestion* @out);

        /// <summary>What a run of this grid does at one cell size.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_count_for(ForeignGrid* grid, double cell_size, GridWork* @out);

        /// <summary>Fits the weights of a grid to timings of the whole run at three different cell sizes or more (0.6,
        /// 1.2 and 2.4 mean edges do), by non-negative least squares, and minimises the cost, from the smallest size
        /// timed over 1.2 to 1.2 times the largest.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_cost_fit(ForeignGrid* grid, GridTiming* timings, ulong count, GridFit* @out);

        /// <summary>Finds the best cell size by running the grid: at three cell sizes an octave apart first, then where
        /// the fit to all timings so far is lowest or least sure, which may be where it was run before, until that is
        /// sure enough (desc-&gt;wanted_loss, after four runs at the earliest) and it was run a quarter of an octave to
        /// either side of the best, or desc-&gt;most_runs are made.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_cost_tune(ForeignGrid* grid, TuneDesc* desc, IntPtr run, IntPtr user, Tuning*
            @out);

        /// <summary>Creates a surface without positions.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_create(SurfaceDesc* desc, IntPtr* out_surface);

        /// <summary>Destroys a surface.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern void vox_surface_destroy(IntPtr surface);

        /// <summary>The edges or faces of a surface, numbered as everywhere in this header.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_get_features(IntPtr surface, Feature feature, FeatureView* out_view);

        /// <summary>Sets the motion that the other functions answer for.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_move(IntPtr surface, Motion* motion);

        /// <summary>All features `b` whose boxes overlap those of the features [first, first + count) of kind `a`;
        /// boxes that touch overlap.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_pairs(IntPtr surface, Feature a, Feature b, ulong first, ulong
            count, PairLists* out_lists);

        /// <summary>Sets vox_surface_desc.cell_size, from the next call on.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_set_cell_size(IntPtr surface, double cell_size);

        /// <summary>The cell size that minimises the cost of finding the pairs of kind `a` with kind `b` for the motion
        /// that is set.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_suggest_cell_size(IntPtr surface, Feature a, Feature b,
            ForeignSuggestion* @out);

        /// <summary>Writes the fields that out_counters-&gt;struct_size covers (set it first).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_get_counters(IntPtr surface, PairCounters* out_counters);

        /// <summary>All edges and faces that have a point in common and no vertex, at the end of the motion: whether
        /// the surface is free of intersections, and where it is not.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_crossings(IntPtr surface, CrossingView* out_view);

        /// <summary>All pairs of features of kinds a and b that are at most `distance` apart, at the end of the motion:
        /// face and vertex, edge and edge, edge and vertex, vertex and vertex, in either order.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_proximities(IntPtr surface, Feature a, Feature b, double
            distance, CloseView* out_view);

        /// <summary>For each vertex a distance, at most `most`: while no vertex has moved further than its own, from
        /// the end of the motion, no face and vertex and no two edges touch that do not touch now (Chen et al. 2025,
        /// Offset Geometric Contact, Sect. 3.3).</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_clearances(IntPtr surface, double most, double* per_vertex, ulong
            vertex_count);

        /// <summary>How much of the motion is free of contact: the least time of first contact of all pairs of faces
        /// and vertices, and of edges and edges.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_safe_step(IntPtr surface, ContactTimeDesc* desc, SafeStep* @out);

        /// <summary>All pairs of FACE and VERTEX, or of EDGE and EDGE, that may come into contact within the motion,
        /// each with its time; pairs that are left out are proven to stay apart. desc null: defaults.</summary>
        [DllImport(vox, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_surface_find_impacts(IntPtr surface, Feature a, Feature b, ContactTimeDesc*
            desc, TimedView* out_view);

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

        /// <summary>Writes vertices, triangles and tets, in the mesh's order. desc null: defaults.</summary>
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

        /// <summary>Creates a simulation without bodies. desc null: all defaults.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_create(SimDesc* desc, IntPtr* out_sim);

        /// <summary>Destroys a simulation with its bodies and its grid.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern void vox_sim_destroy(IntPtr sim);

        /// <summary>The grid inside, for reading the contacts and penetrations of the last detection, counters and
        /// profile, and for setting the cell size and the number of workers.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_get_grid(IntPtr sim, IntPtr* out_grid);

        /// <summary>Moves everything forward by `time_step`, or by max_time_step if that is less.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_step(IntPtr sim, double time_step);

        /// <summary>Adds a body.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_body_insert(IntPtr sim, SimBodyDesc* desc, uint* out_body);

        /// <summary>Removes a body from the simulation and from its grid.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_body_remove(IntPtr sim, uint body);

        /// <summary>The body's arrays.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_body_get_view(IntPtr sim, uint body, SimBodyView* out_view);

        /// <summary>Sets a body's positions and velocities, 3 * vertex_count numbers each; null leaves them as they
        /// are.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_body_set_state(IntPtr sim, uint body, double* positions, double*
            velocities);

        /// <summary>Accelerates all particles of a body from now on, in addition to gravity; 0, 0, 0 at
        /// first.</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_body_set_acceleration(IntPtr sim, uint body, double* acceleration);

        /// <summary>Energy and motion of a body, or of all bodies that are not fixed (body VOX_NULL_BODY).</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_get_energy(IntPtr sim, uint body, SimEnergies* out_energies);

        /// <summary>Writes the fields that out_counts-&gt;struct_size covers (set it first).</summary>
        [DllImport(vox_sim, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        internal static extern Result vox_sim_get_counters(IntPtr sim, SimCounts* out_counts);
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
            entries.Add(Entry("vox_grid_desc", sizeof(GridDesc), 80, 64));
            entries.Add(Entry("vox_grid_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_grid_desc.flags", (byte*)&s.flags - begin, 4, 4));
            entries.Add(Entry("vox_grid_desc.worker_count", (byte*)&s.worker_count - begin, 8, 8));
            entries.Add(Entry("vox_grid_desc.reserved", (byte*)&s.reserved - begin, 12, 12));
            entries.Add(Entry("vox_grid_desc.cell_size", (byte*)&s.cell_size - begin, 16, 16));
            entries.Add(Entry("vox_grid_desc.margin", (byte*)&s.margin - begin, 24, 24));
            entries.Add(Entry("vox_grid_desc.byte_budget", (byte*)&s.byte_budget - begin, 32, 32));
            entries.Add(Entry("vox_grid_desc.closest_budget", (byte*)&s.closest_budget - begin, 40, 40));
            entries.Add(Entry("vox_grid_desc.allocator", (byte*)&s.allocator - begin, 48, 48));
            entries.Add(Entry("vox_grid_desc.log", (byte*)&s.log - begin, 56, 52));
            entries.Add(Entry("vox_grid_desc.tasks", (byte*)&s.tasks - begin, 64, 56));
            entries.Add(Entry("vox_grid_desc.reference", (byte*)&s.reference - begin, 72, 60));
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

        static void AddBodyInfo(List<LayoutEntry> entries)
        {
            BodyInfo s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_body_info", sizeof(BodyInfo), 224, 224));
            entries.Add(Entry("vox_body_info.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_body_info.slot", (byte*)&s.slot - begin, 4, 4));
            entries.Add(Entry("vox_body_info.user_data", (byte*)&s.user_data - begin, 8, 8));
            entries.Add(Entry("vox_body_info.tet_count", (byte*)&s.tet_count - begin, 16, 16));
            entries.Add(Entry("vox_body_info.enabled_tet_count", (byte*)&s.enabled_tet_count - begin, 24, 24));
            entries.Add(Entry("vox_body_info.enabled", (byte*)&s.enabled - begin, 32, 32));
            entries.Add(Entry("vox_body_info.flags", (byte*)&s.flags - begin, 36, 36));
            entries.Add(Entry("vox_body_info.has_transform", (byte*)&s.has_transform - begin, 40, 40));
            entries.Add(Entry("vox_body_info.reserved", (byte*)&s.reserved - begin, 44, 44));
            entries.Add(Entry("vox_body_info.positions", (byte*)&s.positions - begin, 48, 48));
            entries.Add(Entry("vox_body_info.transform", (byte*)&s.transform - begin, 88, 88));
            entries.Add(Entry("vox_body_info.filter", (byte*)&s.filter - begin, 184, 184));
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

        static void AddFailure(List<LayoutEntry> entries)
        {
            Failure s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_failure", sizeof(Failure), 56, 56));
            entries.Add(Entry("vox_failure.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_failure.result", (byte*)&s.result - begin, 4, 4));
            entries.Add(Entry("vox_failure.mesh", (byte*)&s.mesh - begin, 8, 8));
            entries.Add(Entry("vox_failure.slot", (byte*)&s.slot - begin, 12, 12));
            entries.Add(Entry("vox_failure.user_data", (byte*)&s.user_data - begin, 16, 16));
            entries.Add(Entry("vox_failure.vertex", (byte*)&s.vertex - begin, 24, 24));
            entries.Add(Entry("vox_failure.reserved", (byte*)&s.reserved - begin, 28, 28));
            entries.Add(Entry("vox_failure.position", (byte*)&s.position - begin, 32, 32));
        }

        static void AddContact(List<LayoutEntry> entries)
        {
            Contact s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_contact", sizeof(Contact), 32, 32));
            entries.Add(Entry("vox_contact.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_contact.vertex", (byte*)&s.vertex - begin, 4, 4));
            entries.Add(Entry("vox_contact.body_b", (byte*)&s.body_b - begin, 8, 8));
            entries.Add(Entry("vox_contact.tet", (byte*)&s.tet - begin, 12, 12));
            entries.Add(Entry("vox_contact.barycentric", (byte*)&s.barycentric - begin, 16, 16));
        }

        static void AddContactView(List<LayoutEntry> entries)
        {
            ContactView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_contact_view", sizeof(ContactView), 40, 32));
            entries.Add(Entry("vox_contact_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_contact_view.byte_stride", (byte*)&s.byte_stride - begin, 8, 4));
            entries.Add(Entry("vox_contact_view.count", (byte*)&s.count - begin, 16, 8));
            entries.Add(Entry("vox_contact_view.epoch", (byte*)&s.epoch - begin, 24, 16));
            entries.Add(Entry("vox_contact_view.interiors", (byte*)&s.interiors - begin, 32, 24));
        }

        static void AddPenetration(List<LayoutEntry> entries)
        {
            Penetration s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_penetration", sizeof(Penetration), 40, 40));
            entries.Add(Entry("vox_penetration.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_penetration.vertex", (byte*)&s.vertex - begin, 4, 4));
            entries.Add(Entry("vox_penetration.body_b", (byte*)&s.body_b - begin, 8, 8));
            entries.Add(Entry("vox_penetration.state", (byte*)&s.state - begin, 12, 12));
            entries.Add(Entry("vox_penetration.contact", (byte*)&s.contact - begin, 16, 16));
            entries.Add(Entry("vox_penetration.depth", (byte*)&s.depth - begin, 24, 24));
            entries.Add(Entry("vox_penetration.direction", (byte*)&s.direction - begin, 28, 28));
        }

        static void AddPenetrationView(List<LayoutEntry> entries)
        {
            PenetrationView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_penetration_view", sizeof(PenetrationView), 32, 24));
            entries.Add(Entry("vox_penetration_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_penetration_view.byte_stride", (byte*)&s.byte_stride - begin, 8, 4));
            entries.Add(Entry("vox_penetration_view.count", (byte*)&s.count - begin, 16, 8));
            entries.Add(Entry("vox_penetration_view.epoch", (byte*)&s.epoch - begin, 24, 16));
        }

        static void AddDepth(List<LayoutEntry> entries)
        {
            Depth s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_depth", sizeof(Depth), 32, 32));
            entries.Add(Entry("vox_depth.depth", (byte*)&s.depth - begin, 0, 0));
            entries.Add(Entry("vox_depth.direction", (byte*)&s.direction - begin, 8, 8));
        }

        static void AddDepthView(List<LayoutEntry> entries)
        {
            DepthView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_depth_view", sizeof(DepthView), 32, 24));
            entries.Add(Entry("vox_depth_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_depth_view.byte_stride", (byte*)&s.byte_stride - begin, 8, 4));
            entries.Add(Entry("vox_depth_view.count", (byte*)&s.count - begin, 16, 8));
            entries.Add(Entry("vox_depth_view.epoch", (byte*)&s.epoch - begin, 24, 16));
        }

        static void AddEdgeContact(List<LayoutEntry> entries)
        {
            EdgeContact s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_edge_contact", sizeof(EdgeContact), 128, 128));
            entries.Add(Entry("vox_edge_contact.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_edge_contact.edge", (byte*)&s.edge - begin, 4, 4));
            entries.Add(Entry("vox_edge_contact.body_b", (byte*)&s.body_b - begin, 12, 12));
            entries.Add(Entry("vox_edge_contact.face", (byte*)&s.face - begin, 16, 16));
            entries.Add(Entry("vox_edge_contact.tet", (byte*)&s.tet - begin, 28, 28));
            entries.Add(Entry("vox_edge_contact.kind", (byte*)&s.kind - begin, 32, 32));
            entries.Add(Entry("vox_edge_contact.reserved", (byte*)&s.reserved - begin, 36, 36));
            entries.Add(Entry("vox_edge_contact.edge_weights", (byte*)&s.edge_weights - begin, 40, 40));
            entries.Add(Entry("vox_edge_contact.face_weights", (byte*)&s.face_weights - begin, 56, 56));
            entries.Add(Entry("vox_edge_contact.position", (byte*)&s.position - begin, 80, 80));
            entries.Add(Entry("vox_edge_contact.normal", (byte*)&s.normal - begin, 104, 104));
        }

        static void AddEdgeContactView(List<LayoutEntry> entries)
        {
            EdgeContactView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_edge_contact_view", sizeof(EdgeContactView), 32, 24));
            entries.Add(Entry("vox_edge_contact_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_edge_contact_view.byte_stride", (byte*)&s.byte_stride - begin, 8, 4));
            entries.Add(Entry("vox_edge_contact_view.count", (byte*)&s.count - begin, 16, 8));
            entries.Add(Entry("vox_edge_contact_view.epoch", (byte*)&s.epoch - begin, 24, 16));
        }

        static void AddMarginContact(List<LayoutEntry> entries)
        {
            MarginContact s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_margin_contact", sizeof(MarginContact), 88, 88));
            entries.Add(Entry("vox_margin_contact.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_margin_contact.vertex", (byte*)&s.vertex - begin, 4, 4));
            entries.Add(Entry("vox_margin_contact.body_b", (byte*)&s.body_b - begin, 8, 8));
            entries.Add(Entry("vox_margin_contact.tet", (byte*)&s.tet - begin, 12, 12));
            entries.Add(Entry("vox_margin_contact.facet", (byte*)&s.facet - begin, 16, 16));
            entries.Add(Entry("vox_margin_contact.face", (byte*)&s.face - begin, 20, 20));
            entries.Add(Entry("vox_margin_contact.face_weights", (byte*)&s.face_weights - begin, 32, 32));
            entries.Add(Entry("vox_margin_contact.distance", (byte*)&s.distance - begin, 56, 56));
            entries.Add(Entry("vox_margin_contact.normal", (byte*)&s.normal - begin, 64, 64));
        }

        static void AddMarginContactView(List<LayoutEntry> entries)
        {
            MarginContactView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_margin_contact_view", sizeof(MarginContactView), 32, 24));
            entries.Add(Entry("vox_margin_contact_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_margin_contact_view.byte_stride", (byte*)&s.byte_stride - begin, 8, 4));
            entries.Add(Entry("vox_margin_contact_view.count", (byte*)&s.count - begin, 16, 8));
            entries.Add(Entry("vox_margin_contact_view.epoch", (byte*)&s.epoch - begin, 24, 16));
        }

        static void AddPassage(List<LayoutEntry> entries)
        {
            Passage s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_passage", sizeof(Passage), 40, 40));
            entries.Add(Entry("vox_passage.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_passage.vertex", (byte*)&s.vertex - begin, 4, 4));
            entries.Add(Entry("vox_passage.body_b", (byte*)&s.body_b - begin, 8, 8));
            entries.Add(Entry("vox_passage.tet", (byte*)&s.tet - begin, 12, 12));
            entries.Add(Entry("vox_passage.facet", (byte*)&s.facet - begin, 16, 16));
            entries.Add(Entry("vox_passage.face", (byte*)&s.face - begin, 20, 20));
            entries.Add(Entry("vox_passage.time", (byte*)&s.time - begin, 32, 32));
        }

        static void AddPassageView(List<LayoutEntry> entries)
        {
            PassageView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_passage_view", sizeof(PassageView), 32, 24));
            entries.Add(Entry("vox_passage_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_passage_view.byte_stride", (byte*)&s.byte_stride - begin, 8, 4));
            entries.Add(Entry("vox_passage_view.count", (byte*)&s.count - begin, 16, 8));
            entries.Add(Entry("vox_passage_view.epoch", (byte*)&s.epoch - begin, 24, 16));
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
            entries.Add(Entry("vox_pair.first", (byte*)&s.first - begin, 24, 24));
            entries.Add(Entry("vox_pair.a_in_b", (byte*)&s.a_in_b - begin, 32, 32));
            entries.Add(Entry("vox_pair.b_in_a", (byte*)&s.b_in_a - begin, 40, 40));
        }

        static void AddPairView(List<LayoutEntry> entries)
        {
            PairView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_pair_view", sizeof(PairView), 40, 32));
            entries.Add(Entry("vox_pair_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_pair_view.byte_stride", (byte*)&s.byte_stride - begin, 8, 4));
            entries.Add(Entry("vox_pair_view.count", (byte*)&s.count - begin, 16, 8));
            entries.Add(Entry("vox_pair_view.epoch", (byte*)&s.epoch - begin, 24, 16));
            entries.Add(Entry("vox_pair_view.contacts", (byte*)&s.contacts - begin, 32, 24));
        }

        static void AddTouchEvent(List<LayoutEntry> entries)
        {
            TouchEvent s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_touch_event", sizeof(TouchEvent), 32, 32));
            entries.Add(Entry("vox_touch_event.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_touch_event.body_b", (byte*)&s.body_b - begin, 4, 4));
            entries.Add(Entry("vox_touch_event.user_data_a", (byte*)&s.user_data_a - begin, 8, 8));
            entries.Add(Entry("vox_touch_event.user_data_b", (byte*)&s.user_data_b - begin, 16, 16));
            entries.Add(Entry("vox_touch_event.kind", (byte*)&s.kind - begin, 24, 24));
            entries.Add(Entry("vox_touch_event.pair", (byte*)&s.pair - begin, 28, 28));
        }

        static void AddTouchView(List<LayoutEntry> entries)
        {
            TouchView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_touch_view", sizeof(TouchView), 56, 48));
            entries.Add(Entry("vox_touch_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_touch_view.byte_stride", (byte*)&s.byte_stride - begin, 8, 4));
            entries.Add(Entry("vox_touch_view.count", (byte*)&s.count - begin, 16, 8));
            entries.Add(Entry("vox_touch_view.epoch", (byte*)&s.epoch - begin, 24, 16));
            entries.Add(Entry("vox_touch_view.began", (byte*)&s.began - begin, 32, 24));
            entries.Add(Entry("vox_touch_view.persisted", (byte*)&s.persisted - begin, 40, 32));
            entries.Add(Entry("vox_touch_view.ended", (byte*)&s.ended - begin, 48, 40));
        }

        static void AddContactEvent(List<LayoutEntry> entries)
        {
            ContactEvent s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_contact_event", sizeof(ContactEvent), 16, 16));
            entries.Add(Entry("vox_contact_event.body_a", (byte*)&s.body_a - begin, 0, 0));
            entries.Add(Entry("vox_contact_event.vertex", (byte*)&s.vertex - begin, 4, 4));
            entries.Add(Entry("vox_contact_event.body_b", (byte*)&s.body_b - begin, 8, 8));
            entries.Add(Entry("vox_contact_event.kind", (byte*)&s.kind - begin, 12, 12));
        }

        static void AddContactEventView(List<LayoutEntry> entries)
        {
            ContactEventView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_contact_event_view", sizeof(ContactEventView), 48, 40));
            entries.Add(Entry("vox_contact_event_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_contact_event_view.byte_stride", (byte*)&s.byte_stride - begin, 8, 4));
            entries.Add(Entry("vox_contact_event_view.count", (byte*)&s.count - begin, 16, 8));
            entries.Add(Entry("vox_contact_event_view.epoch", (byte*)&s.epoch - begin, 24, 16));
            entries.Add(Entry("vox_contact_event_view.began", (byte*)&s.began - begin, 32, 24));
            entries.Add(Entry("vox_contact_event_view.ended", (byte*)&s.ended - begin, 40, 32));
        }

        static void AddReading(List<LayoutEntry> entries)
        {
            Reading s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_reading", sizeof(Reading), 168, 168));
            entries.Add(Entry("vox_reading.contact", (byte*)&s.contact - begin, 0, 0));
            entries.Add(Entry("vox_reading.known", (byte*)&s.known - begin, 8, 8));
            entries.Add(Entry("vox_reading.state", (byte*)&s.state - begin, 12, 12));
            entries.Add(Entry("vox_reading.depth", (byte*)&s.depth - begin, 16, 16));
            entries.Add(Entry("vox_reading.direction", (byte*)&s.direction - begin, 20, 20));
            entries.Add(Entry("vox_reading.position", (byte*)&s.position - begin, 32, 32));
            entries.Add(Entry("vox_reading.distance", (byte*)&s.distance - begin, 56, 56));
            entries.Add(Entry("vox_reading.surface_position", (byte*)&s.surface_position - begin, 64, 64));
            entries.Add(Entry("vox_reading.barycentric", (byte*)&s.barycentric - begin, 88, 88));
            entries.Add(Entry("vox_reading.normal", (byte*)&s.normal - begin, 112, 112));
            entries.Add(Entry("vox_reading.triangle", (byte*)&s.triangle - begin, 136, 136));
            entries.Add(Entry("vox_reading.reserved", (byte*)&s.reserved - begin, 148, 148));
            entries.Add(Entry("vox_reading.user_data_a", (byte*)&s.user_data_a - begin, 152, 152));
            entries.Add(Entry("vox_reading.user_data_b", (byte*)&s.user_data_b - begin, 160, 160));
        }

        static void AddReadingView(List<LayoutEntry> entries)
        {
            ReadingView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_reading_view", sizeof(ReadingView), 32, 24));
            entries.Add(Entry("vox_reading_view.data", (byte*)&s.data - begin, 0, 0));
            entries.Add(Entry("vox_reading_view.byte_stride", (byte*)&s.byte_stride - begin, 8, 4));
            entries.Add(Entry("vox_reading_view.count", (byte*)&s.count - begin, 16, 8));
            entries.Add(Entry("vox_reading_view.epoch", (byte*)&s.epoch - begin, 24, 16));
        }

        static void AddReadingsDesc(List<LayoutEntry> entries)
        {
            ReadingsDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_readings_desc", sizeof(ReadingsDesc), 24, 24));
            entries.Add(Entry("vox_readings_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_readings_desc.what", (byte*)&s.what - begin, 4, 4));
            entries.Add(Entry("vox_readings_desc.body_a", (byte*)&s.body_a - begin, 8, 8));
            entries.Add(Entry("vox_readings_desc.body_b", (byte*)&s.body_b - begin, 12, 12));
            entries.Add(Entry("vox_readings_desc.closest_budget", (byte*)&s.closest_budget - begin, 16, 16));
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

        static void AddSuggestDesc(List<LayoutEntry> entries)
        {
            SuggestDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_suggest_desc", sizeof(SuggestDesc), 96, 88));
            entries.Add(Entry("vox_suggest_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_suggest_desc.model", (byte*)&s.model - begin, 4, 4));
            entries.Add(Entry("vox_suggest_desc.size_reading", (byte*)&s.size_reading - begin, 8, 8));
            entries.Add(Entry("vox_suggest_desc.area_reading", (byte*)&s.area_reading - begin, 12, 12));
            entries.Add(Entry("vox_suggest_desc.p_nc", (byte*)&s.p_nc - begin, 16, 16));
            entries.Add(Entry("vox_suggest_desc.cost_ratio", (byte*)&s.cost_ratio - begin, 24, 24));
            entries.Add(Entry("vox_suggest_desc.world_edge", (byte*)&s.world_edge - begin, 32, 32));
            entries.Add(Entry("vox_suggest_desc.zone_loss", (byte*)&s.zone_loss - begin, 40, 40));
            entries.Add(Entry("vox_suggest_desc.mean_edge_factor", (byte*)&s.mean_edge_factor - begin, 48, 48));
            entries.Add(Entry("vox_suggest_desc.resolution", (byte*)&s.resolution - begin, 56, 56));
            entries.Add(Entry("vox_suggest_desc.byte_budget", (byte*)&s.byte_budget - begin, 64, 64));
            entries.Add(Entry("vox_suggest_desc.reference_flags", (byte*)&s.reference_flags - begin, 72, 72));
            entries.Add(Entry("vox_suggest_desc.reserved", (byte*)&s.reserved - begin, 76, 76));
            entries.Add(Entry("vox_suggest_desc.weights", (byte*)&s.weights - begin, 80, 80));
            entries.Add(Entry("vox_suggest_desc.allocator", (byte*)&s.allocator - begin, 88, 84));
        }

        static void AddGeometryStats(List<LayoutEntry> entries)
        {
            GeometryStats s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_geometry_stats", sizeof(GeometryStats), 160, 160));
            entries.Add(Entry("vox_geometry_stats.vertices", (byte*)&s.vertices - begin, 0, 0));
            entries.Add(Entry("vox_geometry_stats.tets", (byte*)&s.tets - begin, 8, 8));
            entries.Add(Entry("vox_geometry_stats.edges", (byte*)&s.edges - begin, 16, 16));
            entries.Add(Entry("vox_geometry_stats.facets", (byte*)&s.facets - begin, 24, 24));
            entries.Add(Entry("vox_geometry_stats.boundary_facets", (byte*)&s.boundary_facets - begin, 32, 32));
            entries.Add(Entry("vox_geometry_stats.degenerate_tets", (byte*)&s.degenerate_tets - begin, 40, 40));
            entries.Add(Entry("vox_geometry_stats.mean_edge", (byte*)&s.mean_edge - begin, 48, 48));
            entries.Add(Entry("vox_geometry_stats.mean_longest_edge", (byte*)&s.mean_longest_edge - begin, 56, 56));
            entries.Add(Entry("vox_geometry_stats.mean_box_side", (byte*)&s.mean_box_side - begin, 64, 64));
            entries.Add(Entry("vox_geometry_stats.median_box_side", (byte*)&s.median_box_side - begin, 72, 72));
            entries.Add(Entry("vox_geometry_stats.mean_facet_area", (byte*)&s.mean_facet_area - begin, 80, 80));
            entries.Add(Entry("vox_geometry_stats.mean_tet_facet_area", (byte*)&s.mean_tet_facet_area - begin, 88, 88));
            entries.Add(Entry("vox_geometry_stats.mean_boundary_facet_area", (byte*)&s.mean_boundary_facet_area - begin, 96, 96));
            entries.Add(Entry("vox_geometry_stats.mean_volume", (byte*)&s.mean_volume - begin, 104, 104));
            entries.Add(Entry("vox_geometry_stats.bounds_min", (byte*)&s.bounds_min - begin, 112, 112));
            entries.Add(Entry("vox_geometry_stats.bounds_max", (byte*)&s.bounds_max - begin, 136, 136));
        }

        static void AddCellSizeRules(List<LayoutEntry> entries)
        {
            CellSizeRules s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_cell_size_rules", sizeof(CellSizeRules), 48, 48));
            entries.Add(Entry("vox_cell_size_rules.mean_edge", (byte*)&s.mean_edge - begin, 0, 0));
            entries.Add(Entry("vox_cell_size_rules.mean_edge_multiple", (byte*)&s.mean_edge_multiple - begin, 8, 8));
            entries.Add(Entry("vox_cell_size_rules.object_512", (byte*)&s.object_512 - begin, 16, 16));
            entries.Add(Entry("vox_cell_size_rules.resolution", (byte*)&s.resolution - begin, 24, 24));
            entries.Add(Entry("vox_cell_size_rules.mean_volume", (byte*)&s.mean_volume - begin, 32, 32));
            entries.Add(Entry("vox_cell_size_rules.median_box_side", (byte*)&s.median_box_side - begin, 40, 40));
        }

        static void AddCostSample(List<LayoutEntry> entries)
        {
            CostSample s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_cost_sample", sizeof(CostSample), 16, 16));
            entries.Add(Entry("vox_cost_sample.cell_size", (byte*)&s.cell_size - begin, 0, 0));
            entries.Add(Entry("vox_cost_sample.cost", (byte*)&s.cost - begin, 8, 8));
        }

        static void AddCostShare(List<LayoutEntry> entries)
        {
            CostShare s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_cost_share", sizeof(CostShare), 48, 48));
            entries.Add(Entry("vox_cost_share.name", (byte*)&s.name - begin, 0, 0));
            entries.Add(Entry("vox_cost_share.count", (byte*)&s.count - begin, 24, 24));
            entries.Add(Entry("vox_cost_share.cost", (byte*)&s.cost - begin, 32, 32));
            entries.Add(Entry("vox_cost_share.share", (byte*)&s.share - begin, 40, 40));
        }

        static void AddSuggestion(List<LayoutEntry> entries)
        {
            Suggestion s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_suggestion", sizeof(Suggestion), 1968, 1968));
            entries.Add(Entry("vox_suggestion.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_suggestion.model", (byte*)&s.model - begin, 4, 4));
            entries.Add(Entry("vox_suggestion.cell_size", (byte*)&s.cell_size - begin, 8, 8));
            entries.Add(Entry("vox_suggestion.cells_per_axis", (byte*)&s.cells_per_axis - begin, 16, 16));
            entries.Add(Entry("vox_suggestion.zone_min", (byte*)&s.zone_min - begin, 24, 24));
            entries.Add(Entry("vox_suggestion.zone_max", (byte*)&s.zone_max - begin, 32, 32));
            entries.Add(Entry("vox_suggestion.predicted_cost", (byte*)&s.predicted_cost - begin, 40, 40));
            entries.Add(Entry("vox_suggestion.rules", (byte*)&s.rules - begin, 48, 48));
            entries.Add(Entry("vox_suggestion.stats", (byte*)&s.stats - begin, 96, 96));
            entries.Add(Entry("vox_suggestion.curve", (byte*)&s.curve - begin, 256, 256));
            entries.Add(Entry("vox_suggestion.curve_count", (byte*)&s.curve_count - begin, 1280, 1280));
            entries.Add(Entry("vox_suggestion.term_count", (byte*)&s.term_count - begin, 1284, 1284));
            entries.Add(Entry("vox_suggestion.terms", (byte*)&s.terms - begin, 1288, 1288));
            entries.Add(Entry("vox_suggestion.rule_costs", (byte*)&s.rule_costs - begin, 1864, 1864));
            entries.Add(Entry("vox_suggestion.budget_cell_size", (byte*)&s.budget_cell_size - begin, 1912, 1912));
            entries.Add(Entry("vox_suggestion.uniform_loss", (byte*)&s.uniform_loss - begin, 1920, 1920));
            entries.Add(Entry("vox_suggestion.levels", (byte*)&s.levels - begin, 1928, 1928));
            entries.Add(Entry("vox_suggestion.level_count", (byte*)&s.level_count - begin, 1960, 1960));
            entries.Add(Entry("vox_suggestion.reserved", (byte*)&s.reserved - begin, 1964, 1964));
        }

        static void AddCostMinimum(List<LayoutEntry> entries)
        {
            CostMinimum s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_cost_minimum", sizeof(CostMinimum), 1064, 1064));
            entries.Add(Entry("vox_cost_minimum.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_cost_minimum.curve_count", (byte*)&s.curve_count - begin, 4, 4));
            entries.Add(Entry("vox_cost_minimum.cell_size", (byte*)&s.cell_size - begin, 8, 8));
            entries.Add(Entry("vox_cost_minimum.cost", (byte*)&s.cost - begin, 16, 16));
            entries.Add(Entry("vox_cost_minimum.zone_min", (byte*)&s.zone_min - begin, 24, 24));
            entries.Add(Entry("vox_cost_minimum.zone_max", (byte*)&s.zone_max - begin, 32, 32));
            entries.Add(Entry("vox_cost_minimum.curve", (byte*)&s.curve - begin, 40, 40));
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

        static void AddGridWork(List<LayoutEntry> entries)
        {
            GridWork s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_grid_work", sizeof(GridWork), 48, 48));
            entries.Add(Entry("vox_grid_work.entries", (byte*)&s.entries - begin, 0, 0));
            entries.Add(Entry("vox_grid_work.visits", (byte*)&s.visits - begin, 8, 8));
            entries.Add(Entry("vox_grid_work.empty", (byte*)&s.empty - begin, 16, 16));
            entries.Add(Entry("vox_grid_work.reads", (byte*)&s.reads - begin, 24, 24));
            entries.Add(Entry("vox_grid_work.occupied", (byte*)&s.occupied - begin, 32, 32));
            entries.Add(Entry("vox_grid_work.cells", (byte*)&s.cells - begin, 40, 40));
        }

        static void AddGridWeights(List<LayoutEntry> entries)
        {
            GridWeights s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_grid_weights", sizeof(GridWeights), 56, 56));
            entries.Add(Entry("vox_grid_weights.fixed", (byte*)&s.@fixed - begin, 0, 0));
            entries.Add(Entry("vox_grid_weights.entries", (byte*)&s.entries - begin, 8, 8));
            entries.Add(Entry("vox_grid_weights.visits", (byte*)&s.visits - begin, 16, 16));
            entries.Add(Entry("vox_grid_weights.found", (byte*)&s.found - begin, 24, 24));
            entries.Add(Entry("vox_grid_weights.reads", (byte*)&s.reads - begin, 32, 32));
            entries.Add(Entry("vox_grid_weights.occupied", (byte*)&s.occupied - begin, 40, 40));
            entries.Add(Entry("vox_grid_weights.cells", (byte*)&s.cells - begin, 48, 48));
        }

        static void AddForeignGrid(List<LayoutEntry> entries)
        {
            ForeignGrid s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_foreign_grid", sizeof(ForeignGrid), 128, 120));
            entries.Add(Entry("vox_foreign_grid.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_foreign_grid.flags", (byte*)&s.flags - begin, 4, 4));
            entries.Add(Entry("vox_foreign_grid.content", (byte*)&s.content - begin, 8, 8));
            entries.Add(Entry("vox_foreign_grid.look", (byte*)&s.look - begin, 12, 12));
            entries.Add(Entry("vox_foreign_grid.held", (byte*)&s.held - begin, 16, 16));
            entries.Add(Entry("vox_foreign_grid.asking", (byte*)&s.asking - begin, 24, 20));
            entries.Add(Entry("vox_foreign_grid.radius", (byte*)&s.radius - begin, 32, 24));
            entries.Add(Entry("vox_foreign_grid.least_cell_size", (byte*)&s.least_cell_size - begin, 40, 32));
            entries.Add(Entry("vox_foreign_grid.zone_loss", (byte*)&s.zone_loss - begin, 48, 40));
            entries.Add(Entry("vox_foreign_grid.known", (byte*)&s.known - begin, 56, 48));
            entries.Add(Entry("vox_foreign_grid.reserved", (byte*)&s.reserved - begin, 60, 52));
            entries.Add(Entry("vox_foreign_grid.weights", (byte*)&s.weights - begin, 64, 56));
            entries.Add(Entry("vox_foreign_grid.allocator", (byte*)&s.allocator - begin, 120, 112));
        }

        static void AddForeignRules(List<LayoutEntry> entries)
        {
            ForeignRules s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_foreign_rules", sizeof(ForeignRules), 40, 40));
            entries.Add(Entry("vox_foreign_rules.mean_edge", (byte*)&s.mean_edge - begin, 0, 0));
            entries.Add(Entry("vox_foreign_rules.mean_box_side", (byte*)&s.mean_box_side - begin, 8, 8));
            entries.Add(Entry("vox_foreign_rules.median_box_side", (byte*)&s.median_box_side - begin, 16, 16));
            entries.Add(Entry("vox_foreign_rules.spacing", (byte*)&s.spacing - begin, 24, 24));
            entries.Add(Entry("vox_foreign_rules.radius", (byte*)&s.radius - begin, 32, 32));
        }

        static void AddForeignSuggestion(List<LayoutEntry> entries)
        {
            ForeignSuggestion s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_foreign_suggestion", sizeof(ForeignSuggestion), 2104, 2104));
            entries.Add(Entry("vox_foreign_suggestion.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_foreign_suggestion.warnings", (byte*)&s.warnings - begin, 4, 4));
            entries.Add(Entry("vox_foreign_suggestion.cell_size", (byte*)&s.cell_size - begin, 8, 8));
            entries.Add(Entry("vox_foreign_suggestion.zone_min", (byte*)&s.zone_min - begin, 16, 16));
            entries.Add(Entry("vox_foreign_suggestion.zone_max", (byte*)&s.zone_max - begin, 24, 24));
            entries.Add(Entry("vox_foreign_suggestion.predicted_cost", (byte*)&s.predicted_cost - begin, 32, 32));
            entries.Add(Entry("vox_foreign_suggestion.least_cell_size", (byte*)&s.least_cell_size - begin, 40, 40));
            entries.Add(Entry("vox_foreign_suggestion.work", (byte*)&s.work - begin, 48, 48));
            entries.Add(Entry("vox_foreign_suggestion.weights", (byte*)&s.weights - begin, 96, 96));
            entries.Add(Entry("vox_foreign_suggestion.rules", (byte*)&s.rules - begin, 152, 152));
            entries.Add(Entry("vox_foreign_suggestion.rule_costs", (byte*)&s.rule_costs - begin, 192, 192));
            entries.Add(Entry("vox_foreign_suggestion.curve", (byte*)&s.curve - begin, 232, 232));
            entries.Add(Entry("vox_foreign_suggestion.curve_count", (byte*)&s.curve_count - begin, 1256, 1256));
            entries.Add(Entry("vox_foreign_suggestion.term_count", (byte*)&s.term_count - begin, 1260, 1260));
            entries.Add(Entry("vox_foreign_suggestion.terms", (byte*)&s.terms - begin, 1264, 1264));
            entries.Add(Entry("vox_foreign_suggestion.rule", (byte*)&s.rule - begin, 1840, 1840));
            entries.Add(Entry("vox_foreign_suggestion.reserved", (byte*)&s.reserved - begin, 1844, 1844));
            entries.Add(Entry("vox_foreign_suggestion.note", (byte*)&s.note - begin, 1848, 1848));
        }

        static void AddGridTiming(List<LayoutEntry> entries)
        {
            GridTiming s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_grid_timing", sizeof(GridTiming), 16, 16));
            entries.Add(Entry("vox_grid_timing.cell_size", (byte*)&s.cell_size - begin, 0, 0));
            entries.Add(Entry("vox_grid_timing.seconds", (byte*)&s.seconds - begin, 8, 8));
        }

        static void AddGridFit(List<LayoutEntry> entries)
        {
            GridFit s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_grid_fit", sizeof(GridFit), 1392, 1392));
            entries.Add(Entry("vox_grid_fit.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_grid_fit.warnings", (byte*)&s.warnings - begin, 4, 4));
            entries.Add(Entry("vox_grid_fit.weights", (byte*)&s.weights - begin, 8, 8));
            entries.Add(Entry("vox_grid_fit.residual", (byte*)&s.residual - begin, 64, 64));
            entries.Add(Entry("vox_grid_fit.cell_size", (byte*)&s.cell_size - begin, 72, 72));
            entries.Add(Entry("vox_grid_fit.zone_min", (byte*)&s.zone_min - begin, 80, 80));
            entries.Add(Entry("vox_grid_fit.zone_max", (byte*)&s.zone_max - begin, 88, 88));
            entries.Add(Entry("vox_grid_fit.predicted_seconds", (byte*)&s.predicted_seconds - begin, 96, 96));
            entries.Add(Entry("vox_grid_fit.curve", (byte*)&s.curve - begin, 104, 104));
            entries.Add(Entry("vox_grid_fit.curve_count", (byte*)&s.curve_count - begin, 1128, 1128));
            entries.Add(Entry("vox_grid_fit.reserved", (byte*)&s.reserved - begin, 1132, 1132));
            entries.Add(Entry("vox_grid_fit.note", (byte*)&s.note - begin, 1136, 1136));
        }

        static void AddTuneDesc(List<LayoutEntry> entries)
        {
            TuneDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_tune_desc", sizeof(TuneDesc), 48, 48));
            entries.Add(Entry("vox_tune_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_tune_desc.most_runs", (byte*)&s.most_runs - begin, 4, 4));
            entries.Add(Entry("vox_tune_desc.min", (byte*)&s.min - begin, 8, 8));
            entries.Add(Entry("vox_tune_desc.max", (byte*)&s.max - begin, 16, 16));
            entries.Add(Entry("vox_tune_desc.first", (byte*)&s.first - begin, 24, 24));
            entries.Add(Entry("vox_tune_desc.zone_loss", (byte*)&s.zone_loss - begin, 32, 32));
            entries.Add(Entry("vox_tune_desc.wanted_loss", (byte*)&s.wanted_loss - begin, 40, 40));
        }

        static void AddTuning(List<LayoutEntry> entries)
        {
            Tuning s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_tuning", sizeof(Tuning), 1912, 1912));
            entries.Add(Entry("vox_tuning.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_tuning.warnings", (byte*)&s.warnings - begin, 4, 4));
            entries.Add(Entry("vox_tuning.cell_size", (byte*)&s.cell_size - begin, 8, 8));
            entries.Add(Entry("vox_tuning.zone_min", (byte*)&s.zone_min - begin, 16, 16));
            entries.Add(Entry("vox_tuning.zone_max", (byte*)&s.zone_max - begin, 24, 24));
            entries.Add(Entry("vox_tuning.seconds", (byte*)&s.seconds - begin, 32, 32));
            entries.Add(Entry("vox_tuning.expected_loss", (byte*)&s.expected_loss - begin, 40, 40));
            entries.Add(Entry("vox_tuning.noise", (byte*)&s.noise - begin, 48, 48));
            entries.Add(Entry("vox_tuning.weights", (byte*)&s.weights - begin, 56, 56));
            entries.Add(Entry("vox_tuning.runs", (byte*)&s.runs - begin, 112, 112));
            entries.Add(Entry("vox_tuning.run_count", (byte*)&s.run_count - begin, 624, 624));
            entries.Add(Entry("vox_tuning.curve_count", (byte*)&s.curve_count - begin, 628, 628));
            entries.Add(Entry("vox_tuning.curve", (byte*)&s.curve - begin, 632, 632));
            entries.Add(Entry("vox_tuning.note", (byte*)&s.note - begin, 1656, 1656));
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
            entries.Add(Entry("vox_feature_view", sizeof(FeatureView), 24, 24));
            entries.Add(Entry("vox_feature_view.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_feature_view.vertices_each", (byte*)&s.vertices_each - begin, 4, 4));
            entries.Add(Entry("vox_feature_view.count", (byte*)&s.count - begin, 8, 8));
            entries.Add(Entry("vox_feature_view.vertices", (byte*)&s.vertices - begin, 16, 16));
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

        static void AddPairLists(List<LayoutEntry> entries)
        {
            PairLists s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_pair_lists", sizeof(PairLists), 48, 40));
            entries.Add(Entry("vox_pair_lists.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_pair_lists.reserved", (byte*)&s.reserved - begin, 4, 4));
            entries.Add(Entry("vox_pair_lists.first", (byte*)&s.first - begin, 8, 8));
            entries.Add(Entry("vox_pair_lists.count", (byte*)&s.count - begin, 16, 16));
            entries.Add(Entry("vox_pair_lists.pair_count", (byte*)&s.pair_count - begin, 24, 24));
            entries.Add(Entry("vox_pair_lists.offsets", (byte*)&s.offsets - begin, 32, 32));
            entries.Add(Entry("vox_pair_lists.partners", (byte*)&s.partners - begin, 40, 36));
        }

        static void AddPairCounters(List<LayoutEntry> entries)
        {
            PairCounters s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_pair_counters", sizeof(PairCounters), 72, 72));
            entries.Add(Entry("vox_pair_counters.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_pair_counters.reserved", (byte*)&s.reserved - begin, 4, 4));
            entries.Add(Entry("vox_pair_counters.cell_size", (byte*)&s.cell_size - begin, 8, 8));
            entries.Add(Entry("vox_pair_counters.cells", (byte*)&s.cells - begin, 16, 16));
            entries.Add(Entry("vox_pair_counters.tile_pairs", (byte*)&s.tile_pairs - begin, 24, 24));
            entries.Add(Entry("vox_pair_counters.boxes_compared", (byte*)&s.boxes_compared - begin, 32, 32));
            entries.Add(Entry("vox_pair_counters.overlaps", (byte*)&s.overlaps - begin, 40, 40));
            entries.Add(Entry("vox_pair_counters.culled", (byte*)&s.culled - begin, 48, 48));
            entries.Add(Entry("vox_pair_counters.bytes", (byte*)&s.bytes - begin, 56, 56));
            entries.Add(Entry("vox_pair_counters.peak_bytes", (byte*)&s.peak_bytes - begin, 64, 64));
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
            entries.Add(Entry("vox_crossing_view", sizeof(CrossingView), 24, 24));
            entries.Add(Entry("vox_crossing_view.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_crossing_view.byte_stride", (byte*)&s.byte_stride - begin, 4, 4));
            entries.Add(Entry("vox_crossing_view.count", (byte*)&s.count - begin, 8, 8));
            entries.Add(Entry("vox_crossing_view.crossings", (byte*)&s.crossings - begin, 16, 16));
        }

        static void AddClosePair(List<LayoutEntry> entries)
        {
            ClosePair s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_close_pair", sizeof(ClosePair), 112, 112));
            entries.Add(Entry("vox_close_pair.a", (byte*)&s.a - begin, 0, 0));
            entries.Add(Entry("vox_close_pair.b", (byte*)&s.b - begin, 4, 4));
            entries.Add(Entry("vox_close_pair.distance", (byte*)&s.distance - begin, 8, 8));
            entries.Add(Entry("vox_close_pair.weights_a", (byte*)&s.weights_a - begin, 16, 16));
            entries.Add(Entry("vox_close_pair.weights_b", (byte*)&s.weights_b - begin, 40, 40));
            entries.Add(Entry("vox_close_pair.point_a", (byte*)&s.point_a - begin, 64, 64));
            entries.Add(Entry("vox_close_pair.point_b", (byte*)&s.point_b - begin, 88, 88));
        }

        static void AddCloseView(List<LayoutEntry> entries)
        {
            CloseView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_close_view", sizeof(CloseView), 24, 24));
            entries.Add(Entry("vox_close_view.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_close_view.byte_stride", (byte*)&s.byte_stride - begin, 4, 4));
            entries.Add(Entry("vox_close_view.count", (byte*)&s.count - begin, 8, 8));
            entries.Add(Entry("vox_close_view.pairs", (byte*)&s.pairs - begin, 16, 16));
        }

        static void AddContactTimeDesc(List<LayoutEntry> entries)
        {
            ContactTimeDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_contact_time_desc", sizeof(ContactTimeDesc), 24, 24));
            entries.Add(Entry("vox_contact_time_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_contact_time_desc.most_iterations", (byte*)&s.most_iterations - begin, 4, 4));
            entries.Add(Entry("vox_contact_time_desc.distance", (byte*)&s.distance - begin, 8, 8));
            entries.Add(Entry("vox_contact_time_desc.slack", (byte*)&s.slack - begin, 16, 16));
        }

        static void AddSafeStep(List<LayoutEntry> entries)
        {
            SafeStep s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_safe_step", sizeof(SafeStep), 48, 48));
            entries.Add(Entry("vox_safe_step.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_safe_step.reserved", (byte*)&s.reserved - begin, 4, 4));
            entries.Add(Entry("vox_safe_step.step", (byte*)&s.step - begin, 8, 8));
            entries.Add(Entry("vox_safe_step.pairs", (byte*)&s.pairs - begin, 16, 16));
            entries.Add(Entry("vox_safe_step.unfinished", (byte*)&s.unfinished - begin, 24, 24));
            entries.Add(Entry("vox_safe_step.kind_a", (byte*)&s.kind_a - begin, 32, 32));
            entries.Add(Entry("vox_safe_step.kind_b", (byte*)&s.kind_b - begin, 36, 36));
            entries.Add(Entry("vox_safe_step.a", (byte*)&s.a - begin, 40, 40));
            entries.Add(Entry("vox_safe_step.b", (byte*)&s.b - begin, 44, 44));
        }

        static void AddTimedPair(List<LayoutEntry> entries)
        {
            TimedPair s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_timed_pair", sizeof(TimedPair), 16, 16));
            entries.Add(Entry("vox_timed_pair.a", (byte*)&s.a - begin, 0, 0));
            entries.Add(Entry("vox_timed_pair.b", (byte*)&s.b - begin, 4, 4));
            entries.Add(Entry("vox_timed_pair.time", (byte*)&s.time - begin, 8, 8));
        }

        static void AddTimedView(List<LayoutEntry> entries)
        {
            TimedView s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_timed_view", sizeof(TimedView), 24, 24));
            entries.Add(Entry("vox_timed_view.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_timed_view.byte_stride", (byte*)&s.byte_stride - begin, 4, 4));
            entries.Add(Entry("vox_timed_view.count", (byte*)&s.count - begin, 8, 8));
            entries.Add(Entry("vox_timed_view.pairs", (byte*)&s.pairs - begin, 16, 16));
        }

        static void AddIoLoadDesc(List<LayoutEntry> entries)
        {
            IoLoadDesc s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_load_desc", sizeof(IoLoadDesc), 40, 28));
            entries.Add(Entry("vox_io_load_desc.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_io_load_desc.format", (byte*)&s.format - begin, 4, 4));
            entries.Add(Entry("vox_io_load_desc.mesh", (byte*)&s.mesh - begin, 8, 8));
            entries.Add(Entry("vox_io_load_desc.reserved", (byte*)&s.reserved - begin, 12, 12));
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
            entries.Add(Entry("vox_io_mesh_view", sizeof(IoMeshView), 48, 48));
            entries.Add(Entry("vox_io_mesh_view.positions", (byte*)&s.positions - begin, 0, 0));
            entries.Add(Entry("vox_io_mesh_view.vertex_count", (byte*)&s.vertex_count - begin, 8, 8));
            entries.Add(Entry("vox_io_mesh_view.tets", (byte*)&s.tets - begin, 16, 16));
            entries.Add(Entry("vox_io_mesh_view.tet_count", (byte*)&s.tet_count - begin, 24, 24));
            entries.Add(Entry("vox_io_mesh_view.triangles", (byte*)&s.triangles - begin, 32, 32));
            entries.Add(Entry("vox_io_mesh_view.triangle_count", (byte*)&s.triangle_count - begin, 40, 40));
        }

        static void AddIoReport(List<LayoutEntry> entries)
        {
            IoReport s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_io_report", sizeof(IoReport), 208, 208));
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

        static void AddSimEnergies(List<LayoutEntry> entries)
        {
            SimEnergies s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_sim_energies", sizeof(SimEnergies), 96, 96));
            entries.Add(Entry("vox_sim_energies.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_sim_energies.reserved", (byte*)&s.reserved - begin, 4, 4));
            entries.Add(Entry("vox_sim_energies.kinetic", (byte*)&s.kinetic - begin, 8, 8));
            entries.Add(Entry("vox_sim_energies.potential", (byte*)&s.potential - begin, 16, 16));
            entries.Add(Entry("vox_sim_energies.elastic", (byte*)&s.elastic - begin, 24, 24));
            entries.Add(Entry("vox_sim_energies.mass", (byte*)&s.mass - begin, 32, 32));
            entries.Add(Entry("vox_sim_energies.momentum", (byte*)&s.momentum - begin, 40, 40));
            entries.Add(Entry("vox_sim_energies.centre", (byte*)&s.centre - begin, 64, 64));
            entries.Add(Entry("vox_sim_energies.max_speed", (byte*)&s.max_speed - begin, 88, 88));
        }

        static void AddSimCounts(List<LayoutEntry> entries)
        {
            SimCounts s;
            byte* begin = (byte*)&s;
            entries.Add(Entry("vox_sim_counts", sizeof(SimCounts), 144, 144));
            entries.Add(Entry("vox_sim_counts.struct_size", (byte*)&s.struct_size - begin, 0, 0));
            entries.Add(Entry("vox_sim_counts.bodies", (byte*)&s.bodies - begin, 4, 4));
            entries.Add(Entry("vox_sim_counts.vertices", (byte*)&s.vertices - begin, 8, 8));
            entries.Add(Entry("vox_sim_counts.tets", (byte*)&s.tets - begin, 16, 16));
            entries.Add(Entry("vox_sim_counts.edges", (byte*)&s.edges - begin, 24, 24));
            entries.Add(Entry("vox_sim_counts.volumes", (byte*)&s.volumes - begin, 32, 32));
            entries.Add(Entry("vox_sim_counts.flat_tets", (byte*)&s.flat_tets - begin, 40, 40));
            entries.Add(Entry("vox_sim_counts.inverted_tets", (byte*)&s.inverted_tets - begin, 48, 48));
            entries.Add(Entry("vox_sim_counts.raised_masses", (byte*)&s.raised_masses - begin, 56, 56));
            entries.Add(Entry("vox_sim_counts.softened", (byte*)&s.softened - begin, 64, 64));
            entries.Add(Entry("vox_sim_counts.steps", (byte*)&s.steps - begin, 72, 72));
            entries.Add(Entry("vox_sim_counts.substeps", (byte*)&s.substeps - begin, 80, 80));
            entries.Add(Entry("vox_sim_counts.detections", (byte*)&s.detections - begin, 88, 88));
            entries.Add(Entry("vox_sim_counts.clamped_steps", (byte*)&s.clamped_steps - begin, 96, 96));
            entries.Add(Entry("vox_sim_counts.penetrations", (byte*)&s.penetrations - begin, 104, 104));
            entries.Add(Entry("vox_sim_counts.floor_contacts", (byte*)&s.floor_contacts - begin, 112, 112));
            entries.Add(Entry("vox_sim_counts.step_ns", (byte*)&s.step_ns - begin, 120, 120));
            entries.Add(Entry("vox_sim_counts.detect_ns", (byte*)&s.detect_ns - begin, 128, 128));
            entries.Add(Entry("vox_sim_counts.solve_ns", (byte*)&s.solve_ns - begin, 136, 136));
        }

        /// <summary>All structs and fields. A program whose entries differ must not call the library.</summary>
        internal static List<LayoutEntry> Entries()
        {
            var entries = new List<LayoutEntry>();
            AddPositions(entries);
            AddGridDesc(entries);
            AddGridInfo(entries);
            AddFilter(entries);
            AddMeshDesc(entries);
            AddBodyInfo(entries);
            AddVerticesDesc(entries);
            AddFailure(entries);
            AddContact(entries);
            AddContactView(entries);
            AddPenetration(entries);
            AddPenetrationView(entries);
            AddDepth(entries);
            AddDepthView(entries);
            AddEdgeContact(entries);
            AddEdgeContactView(entries);
            AddMarginContact(entries);
            AddMarginContactView(entries);
            AddPassage(entries);
            AddPassageView(entries);
            AddPair(entries);
            AddPairView(entries);
            AddTouchEvent(entries);
            AddTouchView(entries);
            AddContactEvent(entries);
            AddContactEventView(entries);
            AddReading(entries);
            AddReadingView(entries);
            AddReadingsDesc(entries);
            AddAllocator(entries);
            AddLog(entries);
            AddTaskSystem(entries);
            AddCounter(entries);
            AddCounterView(entries);
            AddQueryDesc(entries);
            AddPointHit(entries);
            AddClosestHit(entries);
            AddBoxHit(entries);
            AddRayHit(entries);
            AddCostWeights(entries);
            AddReferenceDesc(entries);
            AddSuggestDesc(entries);
            AddGeometryStats(entries);
            AddCellSizeRules(entries);
            AddCostSample(entries);
            AddCostShare(entries);
            AddSuggestion(entries);
            AddCostMinimum(entries);
            AddPrimitives(entries);
            AddGridWork(entries);
            AddGridWeights(entries);
            AddForeignGrid(entries);
            AddForeignRules(entries);
            AddForeignSuggestion(entries);
            AddGridTiming(entries);
            AddGridFit(entries);
            AddTuneDesc(entries);
            AddTuning(entries);
            AddSurfaceDesc(entries);
            AddFeatureView(entries);
            AddMotion(entries);
            AddPairLists(entries);
            AddPairCounters(entries);
            AddCrossing(entries);
            AddCrossingView(entries);
            AddClosePair(entries);
            AddCloseView(entries);
            AddContactTimeDesc(entries);
            AddSafeStep(entries);
            AddTimedPair(entries);
            AddTimedView(entries);
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
            AddSimEnergies(entries);
            AddSimCounts(entries);
            return entries;
        }
    }
}
