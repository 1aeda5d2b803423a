using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;

namespace Voxtet
{
    /// <summary>A set of meshes that collide. Dispose returns its memory; a grid that is forgotten returns it when it is
    /// collected. Any number of threads may read a grid at once, or one may change it: a call that breaks that throws an
    /// InvalidOperationException.</summary>
    public sealed unsafe partial class Grid : IDisposable
    {
        readonly GridHandle handle;
        internal ulong version = 1; // what ends views of results raises it
        ulong layout = 1;  // what ends positions raises it

        public Grid() : this(new GridOptions()) { }

        public Grid(GridOptions options) : this(options, IntPtr.Zero, 0) { }

        // A new grid, or one from the bytes of a snapshot. The library copies what the pointers of the desc name.
        Grid(GridOptions options, IntPtr bytes, ulong size)
        {
            if (options == null) throw new ArgumentNullException("options");
            VoxException.CheckLibrary();
            Callbacks callbacks = options.Log == null ? null : new Callbacks(options.Log);
            Log log = callbacks == null ? new Log() : callbacks.Describe();
            ReferenceOptions paper = options.Reference ?? new ReferenceOptions();
            CostWeights weights = Voxtet.CellSize.Sized(paper.Weights);
            var reference = new ReferenceDesc
            {
                struct_size = (uint)sizeof(ReferenceDesc), flags = paper.Flags, hash_table_size = paper.HashTableSize,
                world_min = paper.WorldMin, world_max = paper.WorldMax, weights = &weights
            };
            var desc = new GridDesc
            {
                struct_size = (uint)sizeof(GridDesc), flags = options.Flags, worker_count = options.Workers,
                cell_size = options.CellSize, margin = options.Margin, byte_budget = options.ByteBudget, log = &log,
                max_constraints_per_pair = options.MaxConstraintsPerPair,
                reference = options.Reference == null ? null : &reference
            };
            IntPtr grid;
            Result result = bytes == IntPtr.Zero ? Native.vox_grid_create(&desc, &grid)
                                                 : Native.vox_grid_load(bytes, size, &desc, &grid);
            if (result != Result.Ok && callbacks != null) callbacks.Free();
            VoxException.Check(result);
            handle = new GridHandle(grid) { Callbacks = callbacks };
        }

        /// <summary>A grid from the bytes of Save, which need not be trusted.</summary>
        public static Grid Load(ReadOnlySpan<byte> bytes, GridOptions options = null)
        {
            fixed (byte* data = &MemoryMarshal.GetReference(NotNull(bytes)))
                return new Grid(options ?? new GridOptions(), (IntPtr)data, (ulong)bytes.Length);
        }

        // A span of no elements has a null pointer, which is not allowed where something has to be read.
        static ReadOnlySpan<byte> NotNull(ReadOnlySpan<byte> bytes)
        {
            return bytes.IsEmpty ? new byte[1] : bytes;
        }

        /// <summary>The grid as bytes that are the same on every machine.</summary>
        public byte[] Save()
        {
            using (var use = handle.Read())
            {
                ulong size;
                VoxException.Check(Native.vox_grid_save(use.Pointer, IntPtr.Zero, 0, &size));
                var bytes = new byte[checked((int)size)];
                fixed (byte* data = bytes) VoxException.Check(Native.vox_grid_save(use.Pointer, (IntPtr)data, size, &size));
                return bytes;
            }
        }

        /// <summary>Ends the grid, its views and its positions.</summary>
        public void Dispose()
        {
            ++version;
            ++layout;
            handle.Dispose();
        }

        internal void CheckVersion(ulong since)
        {
            if (since != version || handle.IsClosed)
                throw new InvalidOperationException("this view ended: the grid was stepped, changed or disposed of since");
        }

        internal void CheckLayout(ulong since)
        {
            if (since != layout || handle.IsClosed)
                throw new InvalidOperationException("these positions ended: a mesh was removed or changed, or the grid " +
                                                    "disposed of since");
        }

        internal Handle.Use Read() { return handle.Read(); }
        internal Handle.Use Change() { return handle.Change(); }

        /// <summary>The meshes as they are now, to be asked where they are.</summary>
        public Locator TakeLocator() { return new Locator(this); }

        /// <summary>Version of the library that is loaded, as "major.minor.patch".</summary>
        public static string LibraryVersion { get { return LibraryBuild.Split(' ', ',')[1]; } }

        /// <summary>Compiler, instruction sets and options of that library.</summary>
        public static string LibraryBuild { get { return VoxException.Text(Native.vox_build_info()); } }

        // ---- settings ----

        /// <summary>Removes all meshes and contacts and keeps the settings.</summary>
        public void Clear()
        {
            using (var use = handle.Change())
            {
                ++version;
                ++layout;
                VoxException.Check(Native.vox_grid_clear(use.Pointer));
                handle.FreeAll();
            }
        }

        /// <summary>Takes memory for that many meshes and contacts in advance.</summary>
        public void Reserve(uint meshes, ulong contacts)
        {
            using (var use = handle.Change())
            {
                ++version;
                VoxException.Check(Native.vox_grid_reserve(use.Pointer, meshes, contacts));
            }
        }

        /// <summary>Makes now what steps make of a mesh once, when they first need it.</summary>
        public void Prepare()
        {
            using (var use = handle.Change()) VoxException.Check(Native.vox_grid_prepare(use.Pointer));
        }

        /// <summary>The cell size in use, 0 if none was chosen yet. Set: that of the following steps, 0 for the library's
        /// choice.</summary>
        public double CellSize
        {
            get { return Info.cell_size; }
            set { using (var use = handle.Change()) VoxException.Check(Native.vox_grid_set_cell_size(use.Pointer, value)); }
        }

        /// <summary>Vertices outside another mesh, but no further from it than this, have constraints of
        /// ConstraintKind.Proximity from the next step on; 0: none. Experimental.</summary>
        public double Margin
        {
            get { return Info.margin; }
            set
            {
                using (var use = handle.Change())
                {
                    ++version;
                    VoxException.Check(Native.vox_grid_set_margin(use.Pointer, value));
                }
            }
        }

        /// <summary>As a number of workers: one per core.</summary>
        public const uint AllCores = Native.VOX_ALL_CORES;

        /// <summary>Threads of the following steps, or AllCores; 0: one.</summary>
        public void SetWorkers(uint workers)
        {
            using (var use = handle.Change()) VoxException.Check(Native.vox_grid_set_worker_count(use.Pointer, workers));
        }

        public GridFlags Flags
        {
            get { return Info.flags; }
            set
            {
                using (var use = handle.Change())
                {
                    ++version;
                    VoxException.Check(Native.vox_grid_set_flags(use.Pointer, value));
                }
            }
        }

        // ---- meshes ----

        static Format FormatOf<T>()
        {
            if (typeof(T) == typeof(float)) return Format.Float;
            if (typeof(T) == typeof(double)) return Format.Double;
            throw new ArgumentException("positions are float or double, not " + typeof(T).Name);
        }

        internal static Positions PositionsOf<T>(ReadOnlySpan<T> numbers, string name) where T : struct
        {
            return new Positions { count = Count(numbers.Length, 3, name), format = FormatOf<T>() };
        }

        internal static ulong Count(int numbers, int each, string name)
        {
            if (numbers % each != 0)
                throw new ArgumentException(name + " has " + numbers + " numbers, expected " + each + " for each", name);
            return (ulong)(numbers / each);
        }

        static MeshDesc Describe<T>(ReadOnlySpan<T> positions, ReadOnlySpan<uint> tets) where T : struct
        {
            return new MeshDesc
            {
                struct_size = (uint)sizeof(MeshDesc), flags = MeshFlags.CopyPositions,
                positions = PositionsOf(positions, "positions"), tet_count = Count(tets.Length, 4, "tets")
            };
        }

        Body Insert<T>(ReadOnlySpan<T> positions, ReadOnlySpan<uint> tets, ulong userData, Filter filter,
                       ReadOnlySpan<T> restPositions) where T : struct
        {
            MeshDesc desc = Describe(positions, tets);
            desc.rest_positions = PositionsOf(restPositions, "restPositions");
            desc.user_data = userData;
            desc.filter = filter;
            uint mesh;
            fixed (byte* p = &MemoryMarshal.GetReference(MemoryMarshal.AsBytes(positions)))
            fixed (byte* r = &MemoryMarshal.GetReference(MemoryMarshal.AsBytes(restPositions)))
            fixed (uint* t = &MemoryMarshal.GetReference(tets))
            using (var use = handle.Change())
            {
                desc.positions.data = (IntPtr)p;
                desc.rest_positions.data = (IntPtr)r;
                desc.tets = t;
                VoxException.Check(Native.vox_mesh_insert(use.Pointer, &desc, &mesh));
            }
            return new Body(mesh);
        }

        /// <summary>Adds a mesh: three numbers a vertex, four indices a tetrahedron, both copied. GetPositions moves it.
        /// </summary>
        public Body Add(ReadOnlySpan<float> positions, ReadOnlySpan<uint> tets, ulong userData = 0,
                        Filter filter = default(Filter), ReadOnlySpan<float> restPositions = default(ReadOnlySpan<float>))
        {
            return Insert(positions, tets, userData, filter, restPositions);
        }

        /// <summary>The same of doubles.</summary>
        public Body Add(ReadOnlySpan<double> positions, ReadOnlySpan<uint> tets, ulong userData = 0,
                        Filter filter = default(Filter), ReadOnlySpan<double> restPositions = default(ReadOnlySpan<double>))
        {
            return Insert(positions, tets, userData, filter, restPositions);
        }

        /// <summary>Removes a mesh or a shape. The contacts of the last step stay as they are until the next one.</summary>
        public void Remove(Body body)
        {
            using (var use = handle.Change())
            {
                ++layout;
                VoxException.Check(Native.vox_body_remove(use.Pointer, body.Id));
                handle.KeepPrevious(body.Id, IntPtr.Zero);
                handle.FreeField(body.Id);
            }
        }

        /// <summary>Whether the mesh is one of this grid.</summary>
        public bool Contains(Body body)
        {
            using (var use = handle.Read()) return Native.vox_body_is_valid(use.Pointer, body.Id) != 0;
        }

        /// <summary>All meshes and shapes, in the order of their ids.</summary>
        public Body[] GetBodies()
        {
            using (var use = handle.Read())
            {
                ulong count;
                VoxException.Check(Native.vox_grid_get_bodies(use.Pointer, null, 0, &count));
                var ids = new uint[count];
                fixed (uint* p = ids) VoxException.Check(Native.vox_grid_get_bodies(use.Pointer, p, count, &count));
                return Array.ConvertAll(ids, id => new Body(id));
            }
        }

        static BodyInfo InfoOf(IntPtr grid, Body body)
        {
            BodyInfo info;
            info.struct_size = (uint)sizeof(BodyInfo);
            VoxException.Check(Native.vox_body_get_info(grid, body.Id, &info));
            return info;
        }

        /// <summary>A mesh or a shape as it is now.</summary>
        public BodyFacts GetFacts(Body body)
        {
            BodyInfo info;
            using (var use = handle.Read()) info = InfoOf(use.Pointer, body);
            return new BodyFacts
            {
                UserData = info.user_data,
                Shape = (ShapeKind)info.shape,
                VertexCount = info.positions.count,
                TetCount = info.tet_count,
                EnabledTetCount = info.enabled_tet_count,
                Enabled = info.enabled != 0,
                Flags = info.flags,
                Format = info.positions.format
            };
        }

        /// <summary>The number the mesh was added with.</summary>
        public ulong GetUserData(Body body)
        {
            ulong userData;
            using (var use = handle.Read()) VoxException.Check(Native.vox_body_get_user_data(use.Pointer, body.Id, &userData));
            return userData;
        }

        /// <summary>The tetrahedra of a mesh as they were given, those that are disabled or removed, too.</summary>
        public uint[] GetTets(Body mesh)
        {
            using (var use = handle.Read())
            {
                ulong count;
                VoxException.Check(Native.vox_mesh_get_tets(use.Pointer, mesh.Id, null, null, 0, &count));
                var tets = new uint[4 * count];
                fixed (uint* t = tets)
                    VoxException.Check(Native.vox_mesh_get_tets(use.Pointer, mesh.Id, t, null, count, &count));
                return tets;
            }
        }

        Positions<T> Map<T>(Body mesh) where T : struct
        {
            using (var use = handle.Change())
            {
                BodyInfo info = InfoOf(use.Pointer, mesh);
                if (info.positions.format != FormatOf<T>())
                    throw new ArgumentException("positions of " + mesh + " are " + info.positions.format + ", asked for as " +
                                                FormatOf<T>());
                IntPtr positions;
                VoxException.Check(Native.vox_mesh_map_positions(use.Pointer, mesh.Id, &positions));
                return new Positions<T>(this, layout, (void*)positions, 3 * info.positions.count);
            }
        }

        /// <summary>The positions of a mesh that was added as floats, in the library's memory: write to them between steps.
        /// </summary>
        public Positions<float> GetPositions(Body mesh) { return Map<float>(mesh); }

        /// <summary>The same of a mesh that was added as doubles.</summary>
        public Positions<double> GetDoublePositions(Body mesh) { return Map<double>(mesh); }

        void BindPrevious<T>(Body mesh, ReadOnlySpan<T> numbers) where T : struct
        {
            Positions positions = PositionsOf(numbers, "positions");
            ReadOnlySpan<byte> bytes = MemoryMarshal.AsBytes(numbers);
            using (var use = handle.Change())
            {
                positions.data = bytes.IsEmpty ? IntPtr.Zero : Marshal.AllocHGlobal(bytes.Length);
                bytes.CopyTo(new Span<byte>((void*)positions.data, bytes.Length));
                Result result = Native.vox_mesh_bind_previous_positions(use.Pointer, mesh.Id, &positions);
                if (result == Result.Ok) handle.KeepPrevious(mesh.Id, positions.data);
                else Marshal.FreeHGlobal(positions.data);
                VoxException.Check(result);
            }
        }

        /// <summary>The positions that the vertices of a mesh had before, copied; none: it stands still. From there they move
        /// to their positions in the following steps, which also find impacts. Set them before each step. Experimental.
        /// </summary>
        public void SetPreviousPositions(Body mesh, ReadOnlySpan<float> positions) { BindPrevious(mesh, positions); }

        /// <summary>The same of doubles.</summary>
        public void SetPreviousPositions(Body mesh, ReadOnlySpan<double> positions) { BindPrevious(mesh, positions); }

        /// <summary>Moves a mesh as a whole by an affine map, three rows of four numbers; none: not at all. A shape is
        /// rotated, moved, and scaled along all axes alike.</summary>
        public void SetTransform(Body body, ReadOnlySpan<double> matrix)
        {
            CheckMatrix(matrix);
            fixed (double* m = &MemoryMarshal.GetReference(matrix))
            using (var use = handle.Change()) VoxException.Check(Native.vox_body_set_transform(use.Pointer, body.Id, m));
        }

        static void CheckMatrix(ReadOnlySpan<double> matrix)
        {
            if (matrix.Length != 12 && matrix.Length != 0)
                throw new ArgumentException(matrix.Length + " numbers, expected 12 or none", "matrix");
        }

        /// <summary>Sets what a mesh collides with.</summary>
        public void SetFilter(Body body, Filter filter)
        {
            using (var use = handle.Change()) VoxException.Check(Native.vox_body_set_filter(use.Pointer, body.Id, &filter));
        }

        /// <summary>What a mesh collides with.</summary>
        public Filter GetFilter(Body body)
        {
            using (var use = handle.Read()) return InfoOf(use.Pointer, body).filter;
        }

        /// <summary>Leaves a mesh out of the following steps, or takes it in again.</summary>
        public void SetEnabled(Body body, bool enabled)
        {
            using (var use = handle.Change())
                VoxException.Check(Native.vox_body_set_enabled(use.Pointer, body.Id, enabled ? 1u : 0u));
        }

        /// <summary>Whether two meshes collide, if their filters let them.</summary>
        public void SetPairEnabled(Body a, Body b, bool enabled)
        {
            using (var use = handle.Change())
                VoxException.Check(Native.vox_grid_set_pair_enabled(use.Pointer, a.Id, b.Id, enabled ? 1u : 0u));
        }

        /// <summary>Makes the next step process a mesh even if it did not move, for measurements.</summary>
        public void MarkMoved(Body body)
        {
            using (var use = handle.Change()) VoxException.Check(Native.vox_body_mark_moved(use.Pointer, body.Id));
        }

        // ---- cutting and growing ----

        /// <summary>Replaces vertices, tetrahedra and positions of a mesh.</summary>
        public void SetTopology(Body mesh, ReadOnlySpan<float> positions, ReadOnlySpan<uint> tets)
        {
            MeshDesc desc = Describe(positions, tets);
            fixed (float* p = &MemoryMarshal.GetReference(positions))
            fixed (uint* t = &MemoryMarshal.GetReference(tets))
            using (var use = handle.Change())
            {
                ++layout;
                desc.positions.data = (IntPtr)p;
                desc.tets = t;
                VoxException.Check(Native.vox_mesh_set_topology(use.Pointer, mesh.Id, &desc));
            }
        }

        /// <summary>Disables tetrahedra, so that they contain nothing, or enables them again.</summary>
        public void SetTetsEnabled(Body mesh, ReadOnlySpan<uint> tets, bool enabled)
        {
            fixed (uint* t = &MemoryMarshal.GetReference(tets))
            using (var use = handle.Change())
                VoxException.Check(Native.vox_mesh_set_tets_enabled(use.Pointer, mesh.Id, t, (ulong)tets.Length,
                                                                    enabled ? 1u : 0u));
        }

        /// <summary>Gives tetrahedra other corners, four each.</summary>
        public void ReplaceTets(Body mesh, ReadOnlySpan<uint> tets, ReadOnlySpan<uint> corners)
        {
            if (corners.Length != 4 * tets.Length)
                throw new ArgumentException(corners.Length + " corners, expected " + 4 * tets.Length, "corners");
            fixed (uint* t = &MemoryMarshal.GetReference(tets))
            fixed (uint* c = &MemoryMarshal.GetReference(corners))
            using (var use = handle.Change())
                VoxException.Check(Native.vox_mesh_replace_tets(use.Pointer, mesh.Id, t, (ulong)tets.Length, c));
        }

        /// <summary>Adds tetrahedra of four corners each; the index of the first.</summary>
        public uint AppendTets(Body mesh, ReadOnlySpan<uint> corners)
        {
            uint first;
            ulong count = Count(corners.Length, 4, "corners");
            fixed (uint* c = &MemoryMarshal.GetReference(corners))
            using (var use = handle.Change())
                VoxException.Check(Native.vox_mesh_append_tets(use.Pointer, mesh.Id, c, count, &first));
            return first;
        }

        /// <summary>Removes tetrahedra. Their vertices stay.</summary>
        public void RemoveTets(Body mesh, ReadOnlySpan<uint> tets)
        {
            fixed (uint* t = &MemoryMarshal.GetReference(tets))
            using (var use = handle.Change())
                VoxException.Check(Native.vox_mesh_remove_tets(use.Pointer, mesh.Id, t, (ulong)tets.Length));
        }

        /// <summary>Adds copies of vertices, where these are; the index of the first.</summary>
        public uint AppendCopies(Body mesh, ReadOnlySpan<uint> copiesOf)
        {
            var desc = new VerticesDesc { struct_size = (uint)sizeof(VerticesDesc), count = (ulong)copiesOf.Length };
            uint first;
            fixed (uint* c = &MemoryMarshal.GetReference(copiesOf))
            using (var use = handle.Change())
            {
                ++layout;
                desc.copies_of = c;
                VoxException.Check(Native.vox_mesh_append_vertices(use.Pointer, mesh.Id, &desc, &first));
            }
            return first;
        }

        /// <summary>Adds vertices at these positions, to a mesh that was added as floats; the index of the first.</summary>
        public uint AppendVertices(Body mesh, ReadOnlySpan<float> positions)
        {
            GetPositions(mesh); // of its own, also in a mesh that has had no vertices
            var desc = new VerticesDesc { struct_size = (uint)sizeof(VerticesDesc) };
            uint first;
            desc.positions = PositionsOf(positions, "positions");
            desc.count = desc.positions.count;
            fixed (float* p = &MemoryMarshal.GetReference(positions))
            using (var use = handle.Change())
            {
                ++layout;
                desc.positions.data = (IntPtr)p;
                VoxException.Check(Native.vox_mesh_append_vertices(use.Pointer, mesh.Id, &desc, &first));
            }
            return first;
        }

        /// <summary>Removes vertices that no enabled tetrahedron has.</summary>
        public void RemoveVertices(Body mesh, ReadOnlySpan<uint> vertices)
        {
            fixed (uint* v = &MemoryMarshal.GetReference(vertices))
            using (var use = handle.Change())
                VoxException.Check(Native.vox_mesh_remove_vertices(use.Pointer, mesh.Id, v, (ulong)vertices.Length));
        }

        // ---- step and results ----

        /// <summary>Finds all contacts of the positions as they are now. It ends the views of the last step.</summary>
        public void Step()
        {
            using (var use = handle.Change())
            {
                ++version;
                VoxException.Check(Native.vox_grid_step(use.Pointer));
            }
        }

        /// <summary>Steps many grids, several at the same time, on that many threads (0: one). If grids fail, the others
        /// are stepped nevertheless; the text of the exception begins with the index of the first.</summary>
        public static void StepAll(Grid[] grids, uint workers = AllCores)
        {
            if (grids == null) throw new ArgumentNullException("grids");
            var uses = new Handle.Use[grids.Length];
            int begun = 0;
            try
            {
                var pointers = new IntPtr[grids.Length];
                for (; begun < grids.Length; ++begun)
                {
                    if (grids[begun] == null) throw new ArgumentNullException("grids[" + begun + "]");
                    uses[begun] = grids[begun].handle.Change(); // refuses one that is named twice
                    pointers[begun] = uses[begun].Pointer;
                }
                foreach (Grid grid in grids) ++grid.version;
                fixed (IntPtr* p = pointers)
                    VoxException.Check(Native.vox_grids_step(p, (ulong)pointers.Length, workers, null, null));
            }
            finally
            {
                while (begun > 0) uses[--begun].Dispose();
            }
        }

        // What a call that returned `result` has written. Inside its Use, where no other thread can end it yet.
        View<T> ViewOf<T>(Result result, void* data, ulong count) where T : struct
        {
            VoxException.Check(result);
            return new View<T>(this, version, data, count);
        }

        /// <summary>The contacts of the last step, in canonical order.</summary>
        public View<Contact> Contacts
        {
            get
            {
                ContactView view;
                using (var use = handle.Read())
                    return ViewOf<Contact>(Native.vox_grid_get_contacts(use.Pointer, &view), view.data, view.count);
            }
        }

        /// <summary>For each contact 1 if the vertex is in the interior of the tetrahedron, 0 if on its boundary.</summary>
        public View<byte> Interiors
        {
            get
            {
                ContactView view;
                using (var use = handle.Read())
                    return ViewOf<byte>(Native.vox_grid_get_contacts(use.Pointer, &view), view.interiors, view.count);
            }
        }

        /// <summary>The pairs of meshes that touch, are within the margin, or ended in the last step: Pair.state says which.</summary>
        public View<Pair> Pairs
        {
            get
            {
                PairView view;
                using (var use = handle.Read())
                    return ViewOf<Pair>(Native.vox_grid_get_pairs(use.Pointer, &view), view.data, view.count);
            }
        }

        /// <summary>Indices of the contacts, pair by pair: those of a pair begin at Pair.first_contact.</summary>
        public View<uint> PairContacts
        {
            get
            {
                PairView view;
                ContactView contacts;
                using (var use = handle.Read())
                {
                    VoxException.Check(Native.vox_grid_get_contacts(use.Pointer, &contacts));
                    return ViewOf<uint>(Native.vox_grid_get_pairs(use.Pointer, &view), view.contacts, contacts.count);
                }
            }
        }

        /// <summary>Finds the constraints of the last step, or those of one mesh, or of a mesh with another, or of pairs in
        /// which the category of a mesh has a bit of the mask. It ends the views. With GridFlags.Constraints every step does
        /// so itself. closestBudget: most searches for a closest point; 0: no limit.</summary>
        public void FindConstraints(DepthMethod method = DepthMethod.Consistent, Body a = default(Body),
                                    Body b = default(Body), ulong mask = 0, ulong closestBudget = 0)
        {
            var desc = new ConstraintDesc
            {
                struct_size = (uint)sizeof(ConstraintDesc), method = method, body_a = a.Id, body_b = b.Id, mask = mask,
                closest_budget = closestBudget
            };
            using (var use = handle.Change())
            {
                ++version;
                VoxException.Check(Native.vox_grid_find_constraints(use.Pointer, &desc));
            }
        }

        /// <summary>The constraints that were found last, pair by pair: what a solver needs. vox.h explains each field under
        /// vox_constraint.</summary>
        public View<Constraint> Constraints
        {
            get
            {
                ConstraintView view;
                using (var use = handle.Read())
                    return ViewOf<Constraint>(Native.vox_grid_get_constraints(use.Pointer, &view), view.data, view.count);
            }
        }

        /// <summary>The constraints of Pairs[p] are those from element p on, and before element p + 1.</summary>
        public View<ulong> PairOffsets
        {
            get
            {
                ConstraintView view;
                using (var use = handle.Read())
                    return ViewOf<ulong>(Native.vox_grid_get_constraints(use.Pointer, &view), view.pair_offsets,
                                         view.pair_count + 1);
            }
        }

        /// <summary>The constraints of Pairs[pair].</summary>
        public View<Constraint> ConstraintsOf(int pair)
        {
            View<ulong> offsets = PairOffsets;
            return Constraints.Slice((int)offsets[pair], (int)(offsets[pair + 1] - offsets[pair]));
        }

        /// <summary>A hash of the contacts: the same on every machine and in every language.</summary>
        public ulong Hash
        {
            get
            {
                ulong hash;
                using (var use = handle.Read()) VoxException.Check(Native.vox_grid_get_hash(use.Pointer, &hash));
                return hash;
            }
        }

        /// <summary>Number of steps and other changes so far.</summary>
        public ulong Epoch
        {
            get { return Info.epoch; }
        }

        /// <summary>The index-th mesh that made the last step fail or that it left out; its `body` is 0 beyond the last.
        /// </summary>
        public Failure GetFailure(uint index = 0)
        {
            Failure failure;
            failure.struct_size = (uint)sizeof(Failure);
            using (var use = handle.Read()) VoxException.Check(Native.vox_grid_get_failure(use.Pointer, index, &failure));
            return failure;
        }

        /// <summary>The grid as it is now.</summary>
        public GridInfo Info
        {
            get
            {
                GridInfo info;
                info.struct_size = (uint)sizeof(GridInfo);
                using (var use = handle.Read()) VoxException.Check(Native.vox_grid_get_info(use.Pointer, &info));
                return info;
            }
        }

        /// <summary>A copy of what vox_grid_get_counters gives, by its names: what the last step did, and how long each stage
        /// of it took.</summary>
        public Dictionary<string, ulong> Counters
        {
            get
            {
                var counters = new Dictionary<string, ulong>();
                CounterView view;
                using (var use = handle.Read())
                {
                    VoxException.Check(Native.vox_grid_get_counters(use.Pointer, &view));
                    for (ulong i = 0; i < view.count; ++i)
                        counters.Add(VoxException.Text(view.data[i].name), view.data[i].value);
                }
                return counters;
            }
        }
    }
}
