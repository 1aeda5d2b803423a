using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Threading;

namespace Voxtet
{
    /// <summary>Owns a grid, a locator or a mesh of the library, and knows who uses it. What is disposed of or in use where it
    /// must not be throws; the library itself would be undefined there.</summary>
    internal abstract class Handle : SafeHandle
    {
        int users; // how many threads read; -1 while one changes it

        protected Handle(IntPtr handle) : base(IntPtr.Zero, true)
        {
            SetHandle(handle);
        }

        public override bool IsInvalid { get { return handle == IntPtr.Zero; } }

        internal Use Read()
        {
            for (;;)
            {
                int now = Volatile.Read(ref users);
                if (now < 0) throw Busy();
                if (Interlocked.CompareExchange(ref users, now + 1, now) == now) return new Use(this, 1);
            }
        }

        internal Use Change()
        {
            if (Interlocked.CompareExchange(ref users, -1, 0) != 0) throw Busy();
            return new Use(this, -1);
        }

        static Exception Busy()
        {
            return new InvalidOperationException("one thread changes this object while another uses it, or a callback " +
                                                 "calls the object it came from");
        }

        /// <summary>The handle stays valid until this is disposed of, whatever other threads do.</summary>
        internal struct Use : IDisposable
        {
            readonly Handle owner;
            readonly int share;

            internal Use(Handle owner, int share)
            {
                this.owner = owner;
                this.share = share;
                bool added = false;
                try
                {
                    owner.DangerousAddRef(ref added);
                }
                catch
                {
                    Interlocked.Add(ref owner.users, -share);
                    throw;
                }
            }

            internal IntPtr Pointer { get { return owner.handle; } }

            public void Dispose()
            {
                Interlocked.Add(ref owner.users, -share);
                owner.DangerousRelease();
            }
        }
    }

    internal sealed class GridHandle : Handle
    {
        internal Callbacks Callbacks; // for the library to call as long as the grid lives
        readonly Dictionary<uint, IntPtr> previous = new Dictionary<uint, IntPtr>(); // positions that it borrows, by mesh
        readonly Dictionary<uint, GCHandle> fields = new Dictionary<uint, GCHandle>(); // functions that it calls, by shape

        internal GridHandle(IntPtr grid) : base(grid) { }

        /// <summary>Owns the previous positions of a mesh in place of those before; zero: there are none any more.</summary>
        internal void KeepPrevious(uint mesh, IntPtr positions)
        {
            IntPtr old;
            if (previous.TryGetValue(mesh, out old)) Marshal.FreeHGlobal(old);
            if (positions == IntPtr.Zero) previous.Remove(mesh);
            else previous[mesh] = positions;
        }

        internal void KeepField(uint shape, GCHandle field) { fields[shape] = field; }

        internal void FreeField(uint body)
        {
            GCHandle field;
            if (!fields.TryGetValue(body, out field)) return;
            field.Free();
            fields.Remove(body);
        }

        internal void FreeAll()
        {
            foreach (IntPtr positions in previous.Values) Marshal.FreeHGlobal(positions);
            previous.Clear();
            foreach (GCHandle field in fields.Values) field.Free();
            fields.Clear();
        }

        protected override bool ReleaseHandle()
        {
            Native.vox_grid_destroy(handle);
            FreeAll();
            if (Callbacks != null) Callbacks.Free();
            return true;
        }
    }

    internal sealed class LocatorHandle : Handle
    {
        internal LocatorHandle() : base(IntPtr.Zero) { }

        internal unsafe void Update(IntPtr grid)
        {
            IntPtr locator = handle;
            VoxException.Check(Native.vox_grid_update_locator(grid, &locator));
            SetHandle(locator);
        }

        protected override bool ReleaseHandle()
        {
            Native.vox_locator_release(handle);
            return true;
        }
    }

    internal sealed class MeshFileHandle : Handle
    {
        internal MeshFileHandle(IntPtr mesh) : base(mesh) { }

        protected override bool ReleaseHandle()
        {
            Native.vox_io_mesh_destroy(handle);
            return true;
        }
    }
}
