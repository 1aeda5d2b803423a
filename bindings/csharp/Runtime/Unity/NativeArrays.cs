#if UNITY_5_3_OR_NEWER
using System;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;

namespace Voxtet
{
    /// <summary>Results and positions as Unity's native arrays, for jobs and for Mesh.SetVertices: no copy. With safety
    /// checks (in the editor), an array that is used after the grid's next step throws Unity's own error.</summary>
    public sealed unsafe class NativeArrays : IDisposable
    {
        readonly Grid grid;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
        AtomicSafetyHandle results, positions;
#endif

        public NativeArrays(Grid grid)
        {
            if (grid == null) throw new ArgumentNullException("grid");
            this.grid = grid;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            results = AtomicSafetyHandle.Create();
            positions = AtomicSafetyHandle.Create();
#endif
        }

        /// <summary>Grid.Step. It ends the arrays of results taken before it.</summary>
        public void Step()
        {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            AtomicSafetyHandle.CheckDeallocateAndThrow(results); // a job still reads them
            AtomicSafetyHandle.CheckDeallocateAndThrow(positions); // or writes these
            AtomicSafetyHandle.Release(results);
            results = AtomicSafetyHandle.Create();
#endif
            grid.Step();
        }

        /// <summary>Contacts of the last step.</summary>
        public NativeArray<Contact> Contacts { get { return Array(grid.Contacts.AsSpan()); } }

        /// <summary>The constraints that were found last. Grid.FindConstraints ends them, too, but no error says so.</summary>
        public NativeArray<Constraint> Constraints { get { return Array(grid.Constraints.AsSpan()); } }

        /// <summary>Positions of a mesh that was added as floats, three numbers a vertex: as NativeArray of Vector3 with
        /// Reinterpret. They end when the mesh is removed or gets other or more vertices: dispose of this object then and
        /// make another.</summary>
        public NativeArray<float> Positions(Body mesh)
        {
            Span<float> numbers = grid.GetPositions(mesh).AsSpan();
            fixed (float* p = &System.Runtime.InteropServices.MemoryMarshal.GetReference(numbers))
            {
                NativeArray<float> array =
                    NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<float>(p, numbers.Length, Unity.Collections.Allocator.None);
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                NativeArrayUnsafeUtility.SetAtomicSafetyHandle(ref array, positions);
#endif
                return array;
            }
        }

        // The records are the library's: they do not move.
        NativeArray<T> Array<T>(ReadOnlySpan<T> records) where T : struct
        {
            fixed (byte* p = &System.Runtime.InteropServices.MemoryMarshal.GetReference(
                       System.Runtime.InteropServices.MemoryMarshal.AsBytes(records)))
            {
                NativeArray<T> array =
                    NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<T>(p, records.Length, Unity.Collections.Allocator.None);
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                NativeArrayUnsafeUtility.SetAtomicSafetyHandle(ref array, results);
#endif
                return array;
            }
        }

        public void Dispose()
        {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            AtomicSafetyHandle.CheckDeallocateAndThrow(results);
            AtomicSafetyHandle.CheckDeallocateAndThrow(positions);
            AtomicSafetyHandle.Release(results);
            AtomicSafetyHandle.Release(positions);
#endif
        }
    }
}
#endif
