using System;

namespace Voxtet
{
    /// <summary>Records of the last step, or positions, in the library's memory: no copy, no allocation. It cannot leave the
    /// stack, and throws InvalidOperationException when it is used after what ended it: the next step, a change, Dispose.
    /// </summary>
    public readonly ref struct View<T> where T : struct
    {
        readonly ReadOnlySpan<T> records;
        readonly Grid grid;
        readonly ulong version;

        internal unsafe View(Grid grid, ulong version, void* data, ulong count)
            : this(grid, version, new ReadOnlySpan<T>(data, checked((int)count))) { }

        View(Grid grid, ulong version, ReadOnlySpan<T> records)
        {
            this.grid = grid;
            this.version = version;
            this.records = records;
        }

        void Check()
        {
            if (grid != null) grid.CheckVersion(version);
        }

        public int Length { get { Check(); return records.Length; } }

        public ref readonly T this[int index] { get { Check(); return ref records[index]; } }

        /// <summary>Some of them.</summary>
        public View<T> Slice(int first, int count) { return new View<T>(grid, version, records.Slice(first, count)); }

        /// <summary>A copy of your own.</summary>
        public T[] ToArray()
        {
            Check();
            T[] copy = records.ToArray();
            GC.KeepAlive(grid); // whose memory this was
            return copy;
        }

        /// <summary>The records as a span, which does not notice when they end: use it before the next change of the grid,
        /// and while something still refers to the grid.</summary>
        public ReadOnlySpan<T> AsSpan() { Check(); return records; }

        public Enumerator GetEnumerator()
        {
            Check();
            return new Enumerator(records, grid, version);
        }

        /// <summary>Goes from record to record, and throws when the view has ended on the way.</summary>
        public ref struct Enumerator
        {
            readonly ReadOnlySpan<T> records;
            readonly Grid grid;
            readonly ulong version;
            int index;

            internal Enumerator(ReadOnlySpan<T> records, Grid grid, ulong version)
            {
                this.records = records;
                this.grid = grid;
                this.version = version;
                index = -1;
            }

            public bool MoveNext() { return ++index < records.Length; }

            public ref readonly T Current
            {
                get
                {
                    // No call, as in the common case it would cost more than all the rest. There are no records without a grid.
                    if (grid.version != version) grid.CheckVersion(version);
                    return ref records[index];
                }
            }
        }
    }

    /// <summary>The positions of a mesh: x, y, z of one vertex after the other, to be written between steps. It cannot leave
    /// the stack, and throws when it is used after any mesh of the grid was removed or got other or more vertices.</summary>
    public readonly ref struct Positions<T> where T : struct
    {
        readonly Span<T> numbers;
        readonly Grid grid;
        readonly ulong layout;

        internal unsafe Positions(Grid grid, ulong layout, void* data, ulong count)
        {
            this.grid = grid;
            this.layout = layout;
            numbers = data == null || count == 0 ? Span<T>.Empty : new Span<T>(data, checked((int)count));
        }

        void Check()
        {
            if (grid != null) grid.CheckLayout(layout);
        }

        /// <summary>How many numbers: three a vertex.</summary>
        public int Length { get { Check(); return numbers.Length; } }

        public ref T this[int index] { get { Check(); return ref numbers[index]; } }

        /// <summary>Copies all numbers from an array of the same length.</summary>
        public void Set(ReadOnlySpan<T> source)
        {
            Check();
            if (source.Length != numbers.Length)
                throw new ArgumentException(source.Length + " numbers, expected " + numbers.Length, "source");
            source.CopyTo(numbers);
            GC.KeepAlive(grid); // whose memory this is
        }

        public T[] ToArray()
        {
            Check();
            T[] copy = numbers.ToArray();
            GC.KeepAlive(grid);
            return copy;
        }

        /// <summary>The numbers as a span, which does not notice when they end: use it before a mesh is removed or changed,
        /// and while something still refers to the grid.</summary>
        public Span<T> AsSpan() { Check(); return numbers; }
    }
}
