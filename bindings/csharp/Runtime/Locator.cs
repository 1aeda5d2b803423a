using System;
using System.Runtime.InteropServices;

namespace Voxtet
{
    /// <summary>The meshes of a grid at one moment. Any number of threads may ask it, also while the grid steps or after it
    /// is gone. Positions are three numbers each. A call that returns a count writes as many hits as fit, and returns how
    /// many there are. vox_query.h explains each question.</summary>
    public sealed unsafe class Locator : IDisposable
    {
        readonly LocatorHandle handle = new LocatorHandle();

        internal Locator(Grid grid) { Update(grid); }

        public void Dispose() { handle.Dispose(); }

        /// <summary>Takes the meshes of a grid as they are now instead of those it had. No thread may ask meanwhile.
        /// </summary>
        public void Update(Grid grid)
        {
            if (grid == null) throw new ArgumentNullException("grid");
            using (var use = grid.Change())
            using (handle.Change()) handle.Update(use.Pointer);
        }

        /// <summary>Grid.Epoch when the meshes were taken.</summary>
        public ulong Epoch
        {
            get
            {
                ulong epoch;
                using (var use = handle.Read()) VoxException.Check(Native.vox_locator_get_epoch(use.Pointer, &epoch));
                return epoch;
            }
        }

        /// <summary>The number that a mesh was added with.</summary>
        public ulong GetUserData(Body body)
        {
            ulong userData;
            using (var use = handle.Read())
                VoxException.Check(Native.vox_locator_get_user_data(use.Pointer, body.Id, &userData));
            return userData;
        }

        static Positions At(double* data, ReadOnlySpan<double> numbers, string name)
        {
            Positions positions = Grid.PositionsOf(numbers, name);
            positions.data = (IntPtr)data;
            return positions;
        }

        static void CheckRoom(ReadOnlySpan<double> positions, int room, string name)
        {
            if (room < positions.Length / 3)
                throw new ArgumentException("room for " + room + ", expected " + positions.Length / 3, name);
        }

        /// <summary>The tetrahedra that contain points, sorted by point.</summary>
        public ulong FindPointHits(ReadOnlySpan<double> points, Span<PointHit> hits, QueryDesc desc = default(QueryDesc))
        {
            ulong count;
            desc.struct_size = (uint)sizeof(QueryDesc);
            fixed (double* p = &MemoryMarshal.GetReference(points))
            fixed (PointHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
            {
                Positions at = At(p, points, "points");
                VoxException.Check(Native.vox_locator_find_point_hits(use.Pointer, &at, &desc, h, (ulong)hits.Length, &count));
            }
            return count;
        }

        /// <summary>Where each point is, with the weights that interpolate a field there; outside, of the closest point, or
        /// with QueryFlags.Extrapolate of the point itself.</summary>
        public void Locate(ReadOnlySpan<double> points, Span<Location> locations, QueryDesc desc = default(QueryDesc))
        {
            CheckRoom(points, locations.Length, "locations");
            desc.struct_size = (uint)sizeof(QueryDesc);
            fixed (double* p = &MemoryMarshal.GetReference(points))
            fixed (Location* l = &MemoryMarshal.GetReference(locations))
            using (var use = handle.Read())
            {
                Positions at = At(p, points, "points");
                VoxException.Check(Native.vox_locator_locate(use.Pointer, &at, &desc, l));
            }
        }

        /// <summary>The closest point of all surfaces, for each point; its body is 0 where there is none.</summary>
        public void FindClosest(ReadOnlySpan<double> points, Span<ClosestHit> hits, QueryDesc desc = default(QueryDesc))
        {
            CheckRoom(points, hits.Length, "hits");
            desc.struct_size = (uint)sizeof(QueryDesc);
            fixed (double* p = &MemoryMarshal.GetReference(points))
            fixed (ClosestHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
            {
                Positions at = At(p, points, "points");
                VoxException.Check(Native.vox_locator_find_closest(use.Pointer, &at, &desc, h));
            }
        }

        /// <summary>The tetrahedra whose bounding boxes meet boxes, sorted by box.</summary>
        public ulong FindBoxHits(ReadOnlySpan<double> min, ReadOnlySpan<double> max, Span<BoxHit> hits,
                                 QueryDesc desc = default(QueryDesc))
        {
            ulong count;
            desc.struct_size = (uint)sizeof(QueryDesc);
            fixed (double* a = &MemoryMarshal.GetReference(min), b = &MemoryMarshal.GetReference(max))
            fixed (BoxHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
            {
                Positions lows = At(a, min, "min"), highs = At(b, max, "max");
                VoxException.Check(Native.vox_locator_find_box_hits(use.Pointer, &lows, &highs, &desc, h, (ulong)hits.Length,
                                                                    &count));
            }
            return count;
        }

        /// <summary>The facets that rays meet, sorted by (ray, t); with QueryFlags.FirstHit only the first of each ray.
        /// </summary>
        public ulong FindRayHits(ReadOnlySpan<double> from, ReadOnlySpan<double> to, Span<RayHit> hits,
                                 QueryDesc desc = default(QueryDesc))
        {
            ulong count;
            desc.struct_size = (uint)sizeof(QueryDesc);
            fixed (double* a = &MemoryMarshal.GetReference(from), b = &MemoryMarshal.GetReference(to))
            fixed (RayHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
            {
                Positions begins = At(a, from, "from"), ends = At(b, to, "to");
                VoxException.Check(Native.vox_locator_find_ray_hits(use.Pointer, &begins, &ends, &desc, h, (ulong)hits.Length,
                                                                    &count));
            }
            return count;
        }

        /// <summary>The tetrahedra that segments pass through, sorted by (segment, body, t_in).</summary>
        public ulong FindTracks(ReadOnlySpan<double> from, ReadOnlySpan<double> to, Span<TrackPiece> pieces,
                                QueryDesc desc = default(QueryDesc))
        {
            ulong count;
            desc.struct_size = (uint)sizeof(QueryDesc);
            fixed (double* a = &MemoryMarshal.GetReference(from), b = &MemoryMarshal.GetReference(to))
            fixed (TrackPiece* t = &MemoryMarshal.GetReference(pieces))
            using (var use = handle.Read())
            {
                Positions begins = At(a, from, "from"), ends = At(b, to, "to");
                VoxException.Check(Native.vox_locator_find_tracks(use.Pointer, &begins, &ends, &desc, t, (ulong)pieces.Length,
                                                                  &count));
            }
            return count;
        }

        /// <summary>The closest points of segments and all surfaces; the distance is 0 where a segment meets a
        /// surface.</summary>
        public void FindClosestToSegments(ReadOnlySpan<double> from, ReadOnlySpan<double> to, Span<ClosestHit> hits,
                                          QueryDesc desc = default(QueryDesc))
        {
            CheckRoom(from, hits.Length, "hits");
            desc.struct_size = (uint)sizeof(QueryDesc);
            fixed (double* a = &MemoryMarshal.GetReference(from), b = &MemoryMarshal.GetReference(to))
            fixed (ClosestHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
            {
                Positions begins = At(a, from, "from"), ends = At(b, to, "to");
                VoxException.Check(Native.vox_locator_find_closest_to_segments(use.Pointer, &begins, &ends, &desc, h));
            }
        }

        /// <summary>The tetrahedra that triangles meet, each of three corners, sorted by (triangle, body, t). They move to the
        /// corners in <paramref name="to"/>, or stand still if it is empty.</summary>
        public ulong FindTriangleHits(ReadOnlySpan<double> from, ReadOnlySpan<double> to, Span<TriangleHit> hits,
                                      QueryDesc desc = default(QueryDesc))
        {
            ulong count;
            desc.struct_size = (uint)sizeof(QueryDesc);
            fixed (double* a = &MemoryMarshal.GetReference(from), b = &MemoryMarshal.GetReference(to))
            fixed (TriangleHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
            {
                Positions begins = At(a, from, "from"), ends = At(b, to, "to");
                VoxException.Check(Native.vox_locator_find_triangle_hits(use.Pointer, &begins, to.IsEmpty ? null : &ends, &desc,
                                                                         h, (ulong)hits.Length, &count));
            }
            return count;
        }

        /// <summary>Whether each ray meets a tetrahedron: 1 or 0.</summary>
        public void TestRays(ReadOnlySpan<double> from, ReadOnlySpan<double> to, Span<byte> blocked,
                             QueryDesc desc = default(QueryDesc))
        {
            CheckRoom(from, blocked.Length, "blocked");
            desc.struct_size = (uint)sizeof(QueryDesc);
            fixed (double* a = &MemoryMarshal.GetReference(from), b = &MemoryMarshal.GetReference(to))
            fixed (byte* r = &MemoryMarshal.GetReference(blocked))
            using (var use = handle.Read())
            {
                Positions begins = At(a, from, "from"), ends = At(b, to, "to");
                VoxException.Check(Native.vox_locator_test_rays(use.Pointer, &begins, &ends, &desc, r));
            }
        }
    }
}
