using System;

namespace Voxtet
{
    /// <summary>Names a mesh in its grid. The number of a removed mesh is never used again, so a stale one is refused.
    /// </summary>
    public readonly struct Mesh : IEquatable<Mesh>
    {
        /// <summary>The number that contacts, pairs and events have in body_a and body_b.</summary>
        public readonly uint Id;

        public Mesh(uint id) { Id = id; }

        public static readonly Mesh None = new Mesh(Native.VOX_NULL_BODY);

        public bool Equals(Mesh other) { return Id == other.Id; }
        public override bool Equals(object other) { return other is Mesh && Equals((Mesh)other); }
        public override int GetHashCode() { return (int)Id; }
        public static bool operator ==(Mesh a, Mesh b) { return a.Id == b.Id; }
        public static bool operator !=(Mesh a, Mesh b) { return a.Id != b.Id; }
        public override string ToString() { return "Mesh " + Id; }
    }

    /// <summary>Settings of a grid. vox.h explains each under vox_grid_desc.</summary>
    public sealed class GridOptions
    {
        public Engine Engine;
        public Storage Storage;
        /// <summary>Edge of a cell; 0: the library chooses.</summary>
        public double CellSize;
        /// <summary>Most bytes the grid may hold; 0: no limit.</summary>
        public ulong ByteBudget = 4ul << 30;
        /// <summary>Threads of a step; 0: one per core.</summary>
        public uint Workers = 1;
        public GridFlags Flags = GridFlags.Penetrations;
        /// <summary>Most searches for a closest point in a step; 0: no limit.</summary>
        public ulong ClosestBudget;
        /// <summary>Receives warnings and notes, on the thread that called; it must not call the grid.</summary>
        public Action<LogLevel, string> Log;

        internal unsafe GridDesc Desc(out Callbacks callbacks)
        {
            GridDesc desc;
            VoxException.Check(Native.vox_grid_desc_init(&desc, (uint)sizeof(GridDesc)));
            desc.engine = Engine;
            desc.storage = Storage;
            desc.cell_size = CellSize;
            desc.byte_budget = ByteBudget;
            desc.worker_count = Workers;
            desc.flags = Flags;
            desc.closest_budget = ClosestBudget;
            callbacks = Log == null ? null : new Callbacks(Log);
            if (callbacks != null) callbacks.Install(ref desc);
            return desc;
        }
    }

    /// <summary>A mesh as it is now.</summary>
    public struct MeshFacts
    {
        public ulong UserData;
        /// <summary>With the removed ones.</summary>
        public ulong VertexCount;
        /// <summary>With those that are disabled or removed.</summary>
        public ulong TetCount;
        public ulong EnabledTetCount;
        public bool Enabled;
        public MeshFlags Flags;
        public Format Format;
    }
}
