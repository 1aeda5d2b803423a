using System;
using System.Runtime.InteropServices;

namespace Voxtet
{
    /// <summary>What a grid stores, or what queries it: each primitive is a few vertices, of which only the box counts.</summary>
    public sealed class PrimitiveArrays
    {
        readonly Array positions;
        readonly uint[] indices;

        /// <summary>Three numbers a vertex. The vertices of each primitive: two indices an edge or a box, three a triangle, four
        /// a tetrahedron, one a point; without indices, the vertices in their order. The arrays are used, not copied.</summary>
        public PrimitiveArrays(PrimitiveType type, float[] positions, uint[] indices = null)
            : this(type, (Array)positions, indices)
        {
        }

        /// <summary>The same in doubles.</summary>
        public PrimitiveArrays(PrimitiveType type, double[] positions, uint[] indices = null)
            : this(type, (Array)positions, indices)
        {
        }

        PrimitiveArrays(PrimitiveType type, Array positions, uint[] indices)
        {
            if (positions == null) throw new ArgumentNullException("positions");
            if (positions.Length % 3 != 0)
                throw new ArgumentException(positions.Length + " numbers, expected 3 a vertex", "positions");
            Type = type;
            this.positions = positions;
            this.indices = indices;
            int vertices = indices == null ? positions.Length / 3 : indices.Length, width = Width;
            if (vertices % width != 0)
                throw new ArgumentException(vertices + " vertices, expected " + width + " for each primitive",
                                            indices == null ? "positions" : "indices");
        }

        public PrimitiveType Type { get; private set; }

        /// <summary>Of all primitives, added to their own.</summary>
        public double Radius { get; set; }

        /// <summary>One for each primitive, or null.</summary>
        public double[] Radii { get; set; }

        int Width
        {
            get
            {
                switch (Type)
                {
                    case PrimitiveType.Edge:
                    case PrimitiveType.Box: return 2;
                    case PrimitiveType.Triangle: return 3;
                    case PrimitiveType.Tet: return 4;
                    default: return 1;
                }
            }
        }

        internal unsafe Primitives Describe(Func<Array, IntPtr> pin)
        {
            int count = (indices == null ? positions.Length / 3 : indices.Length) / Width;
            if (Radii != null && Radii.Length != count)
                throw new ArgumentException(Radii.Length + " radii, expected " + count, "Radii");
            return new Primitives
            {
                struct_size = (uint)sizeof(Primitives), type = Type,
                positions = new Positions
                {
                    data = pin(positions), count = (ulong)positions.Length / 3,
                    format = positions is double[] ? Format.Double : Format.Float
                },
                indices = (uint*)pin(indices), count = (ulong)count,
                radii = pin(Radii), radius_format = Format.Double, radius = Radius
            };
        }
    }

    /// <summary>A uniform grid of another library. What is Default, or 0, is as `Known` has it.</summary>
    public sealed class GridDescription
    {
        public GridDescription(PrimitiveArrays stored, KnownGrid known = KnownGrid.None)
        {
            if (stored == null) throw new ArgumentNullException("stored");
            Stored = stored;
            Known = known;
        }

        /// <summary>The primitives in cells.</summary>
        public PrimitiveArrays Stored { get; private set; }

        /// <summary>The queries; null: the stored primitives query each other.</summary>
        public PrimitiveArrays Querying { get; set; }

        public KnownGrid Known { get; private set; }
        public CellsStored CellsStored { get; set; }
        public CellsQueried CellsQueried { get; set; }
        public CellsKept CellsKept { get; set; }

        /// <summary>Nanoseconds, as in Suggestion.Weights.</summary>
        public ForeignWeights Weights { get; set; }

        /// <summary>Boxes of queries are larger by this on all sides.</summary>
        public double Radius { get; set; }

        /// <summary>The smallest that gives right answers; 0: any, or what 27 cells demand.</summary>
        public double MinCellSize { get; set; }

        /// <summary>The zone is where the predicted cost is at most 1 + this of the least; 0: 0.05.</summary>
        public double ZoneLoss { get; set; }
    }

    /// <summary>A description as C has it, while a call lasts.</summary>
    sealed unsafe class DescribedGrid : IDisposable
    {
        readonly GCHandle[] pins = new GCHandle[6];
        int pinned;
        IntPtr memory;

        internal DescribedGrid(GridDescription grid)
        {
            if (grid == null) throw new ArgumentNullException("grid");
            VoxException.CheckLibrary();
            try
            {
                // The structs point to each other, so they lie outside of the collector's memory.
                memory = Marshal.AllocHGlobal(sizeof(ForeignGrid) + 2 * sizeof(Primitives));
                ForeignGrid* desc = Grid;
                var primitives = (Primitives*)(desc + 1);
                *desc = new ForeignGrid
                {
                    struct_size = (uint)sizeof(ForeignGrid), known = grid.Known, cells_stored = grid.CellsStored,
                    cells_queried = grid.CellsQueried, cells_kept = grid.CellsKept, stored = primitives, radius = grid.Radius,
                    min_cell_size = grid.MinCellSize, zone_loss = grid.ZoneLoss, weights = grid.Weights
                };
                primitives[0] = grid.Stored.Describe(Pin);
                if (grid.Querying == null) return;
                primitives[1] = grid.Querying.Describe(Pin);
                desc->querying = primitives + 1;
            }
            catch
            {
                Dispose();
                throw;
            }
        }

        internal ForeignGrid* Grid
        {
            get { return (ForeignGrid*)memory; }
        }

        IntPtr Pin(Array array)
        {
            if (array == null) return IntPtr.Zero;
            pins[pinned] = GCHandle.Alloc(array, GCHandleType.Pinned);
            return pins[pinned++].AddrOfPinnedObject();
        }

        public void Dispose()
        {
            while (pinned > 0) pins[--pinned].Free();
            Marshal.FreeHGlobal(memory);
            memory = IntPtr.Zero;
        }
    }
}
