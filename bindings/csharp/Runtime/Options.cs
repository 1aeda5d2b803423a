using System;

namespace Voxtet
{
    /// <summary>Names a mesh or a shape in its grid. The number of a removed one is never used again, so a stale one is refused.
    /// </summary>
    public readonly struct Body : IEquatable<Body>
    {
        /// <summary>The number that contacts, pairs and constraints have in body_a and body_b.</summary>
        public readonly uint Id;

        public Body(uint id) { Id = id; }

        public static readonly Body None = new Body(Native.VOX_NULL_BODY);

        public bool Equals(Body other) { return Id == other.Id; }
        public override bool Equals(object other) { return other is Body && Equals((Body)other); }
        public override int GetHashCode() { return (int)Id; }
        public static bool operator ==(Body a, Body b) { return a.Id == b.Id; }
        public static bool operator !=(Body a, Body b) { return a.Id != b.Id; }
        public override string ToString() { return "Body " + Id; }
    }

    /// <summary>Settings of a grid. vox.h explains each under vox_grid_desc.</summary>
    public sealed class GridOptions
    {
        /// <summary>Edge of a cell; 0: the library chooses.</summary>
        public double CellSize;
        /// <summary>Most bytes the grid may hold; 0: 4 GiB, ulong.MaxValue: no limit.</summary>
        public ulong ByteBudget;
        /// <summary>Threads of a step, or Grid.AllCores; 0: one.</summary>
        public uint Workers;
        public GridFlags Flags;
        /// <summary>See Grid.Margin.</summary>
        public double Margin;
        /// <summary>Most constraints of a pair; 0: all.</summary>
        public uint MaxConstraintsPerPair;
        /// <summary>Receives warnings and notes, on the thread that called; it must not call the grid.</summary>
        public Action<LogLevel, string> Log;
        /// <summary>The paper's engine with these settings; null: the fast engine, and in Load the one that was saved.
        /// </summary>
        public ReferenceOptions Reference;
    }

    /// <summary>Settings of the paper's engine. vox_cell_size.h explains each under vox_reference_desc.</summary>
    public sealed class ReferenceOptions
    {
        public ReferenceFlags Flags;
        /// <summary>Buckets; 0: twice the number of vertices.</summary>
        public ulong HashTableSize;
        /// <summary>Dense: the box that has cells; all 0: that of all positions.</summary>
        public Double3 WorldMin, WorldMax;
        /// <summary>By which it chooses its cell size, from CellSize.Calibrate; null: those shipped with the library.</summary>
        public CostWeights? Weights;
    }

    /// <summary>A mesh as it is now.</summary>
    public struct BodyFacts
    {
        public ulong UserData;
        /// <summary>None for a mesh.</summary>
        public ShapeKind Shape;
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
