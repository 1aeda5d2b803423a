using System;
using System.Runtime.InteropServices;

namespace Voxtet
{
    public sealed unsafe partial class Grid
    {
        /// <summary>Copies the present positions for the queries of this grid.</summary>
        public void PrepareQueries()
        {
            using (var use = handle.Change()) VoxException.Check(Native.vox_grid_prepare_queries(use.Pointer));
        }

        /// <summary>A view of the meshes as they are now, which other threads may ask while this grid steps.</summary>
        public QueryView TakeQueryView()
        {
            IntPtr view;
            using (var use = handle.Change()) VoxException.Check(Native.vox_grid_take_query_view(use.Pointer, &view));
            return new QueryView(new QueryViewHandle(view));
        }

        /// <summary>The tetrahedra that contain points of three doubles each, sorted by point. A mesh takes part if its
        /// filter's category has a bit of the mask. Returns how many there are; as many as fit are written.</summary>
        public ulong QueryPoints(ReadOnlySpan<double> points, Span<PointHit> hits, ulong mask = ulong.MaxValue)
        {
            ulong count;
            fixed (double* p = &MemoryMarshal.GetReference(points))
            fixed (PointHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
                VoxException.Check(Native.vox_grid_query_points(use.Pointer, PointsOf(p), Format.Double, 0,
                                                                Count(points.Length, 3, "points"), mask, h,
                                                                (ulong)hits.Length, &count));
            return count;
        }

        // An array of no points may be null to C#, and not to C.
        internal static IntPtr PointsOf(double* points) { return points == null ? new IntPtr(8) : (IntPtr)points; }

        internal static ClosestDesc DescribeClosest(ReadOnlySpan<double> points, int hits, double maxDistance, ulong mask,
                                                    Mesh excluded)
        {
            ulong count = Count(points.Length, 3, "points");
            if ((ulong)hits < count) throw new ArgumentException(hits + " hits for " + count + " points", "hits");
            return new ClosestDesc
            {
                struct_size = (uint)sizeof(ClosestDesc), format = Format.Double, point_count = count,
                max_distance = maxDistance, mask = mask, excluded = excluded.Id
            };
        }

        /// <summary>The closest surface of each point, with a normal and a sign; its mesh is 0 where there is none within
        /// the distance. A maxDistance of 0 is any distance, a mask of 0 all meshes.</summary>
        public void QueryClosest(ReadOnlySpan<double> points, Span<ClosestHit> hits,
                                 double maxDistance = double.PositiveInfinity, ulong mask = ulong.MaxValue,
                                 Mesh excluded = default(Mesh))
        {
            ClosestDesc desc = DescribeClosest(points, hits.Length, maxDistance, mask, excluded);
            fixed (double* p = &MemoryMarshal.GetReference(points))
            fixed (ClosestHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
            {
                ClosestHit none;
                desc.points = (IntPtr)p;
                VoxException.Check(Native.vox_grid_query_closest_points(use.Pointer, &desc, h == null ? &none : h));
            }
        }

        /// <summary>The tetrahedra whose bounding box meets a box. Returns how many there are; as many as fit are written.
        /// </summary>
        public ulong QueryBox(Double3 min, Double3 max, Span<TetHit> hits, ulong mask = ulong.MaxValue)
        {
            ulong count;
            fixed (TetHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
                VoxException.Check(Native.vox_grid_query_box(use.Pointer, (double*)&min, (double*)&max, mask, h,
                                                             (ulong)hits.Length, &count));
            return count;
        }

        /// <summary>The first tetrahedron and the first facet that a segment hits; mesh and surface_mesh are 0 where there
        /// is none.</summary>
        public RayHit QueryRay(Double3 from, Double3 to, ulong mask = ulong.MaxValue)
        {
            RayHit hit;
            using (var use = handle.Read())
                VoxException.Check(Native.vox_grid_query_ray(use.Pointer, (double*)&from, (double*)&to, mask, &hit));
            return hit;
        }

        /// <summary>All facets that a segment hits. Returns how many there are; as many as fit are written.</summary>
        public ulong QueryRayHits(Double3 from, Double3 to, Span<FacetHit> hits, ulong mask = ulong.MaxValue,
                                  Mesh excluded = default(Mesh))
        {
            ulong count;
            fixed (FacetHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
                VoxException.Check(Native.vox_grid_query_ray_hits(use.Pointer, (double*)&from, (double*)&to, mask, excluded.Id,
                                                                  h, (ulong)hits.Length, &count));
            return count;
        }

        /// <summary>Whether a segment hits any tetrahedron.</summary>
        public bool QueryRayAny(Double3 from, Double3 to, ulong mask = ulong.MaxValue, Mesh excluded = default(Mesh))
        {
            uint any;
            using (var use = handle.Read())
                VoxException.Check(Native.vox_grid_query_ray_any(use.Pointer, (double*)&from, (double*)&to, mask, excluded.Id,
                                                                 &any));
            return any != 0;
        }
    }

    /// <summary>The meshes of a grid at one moment, to be asked at any later time and on any thread, also while the grid
    /// steps or after it is gone.</summary>
    public sealed unsafe class QueryView : IDisposable
    {
        readonly QueryViewHandle handle;

        internal QueryView(QueryViewHandle handle) { this.handle = handle; }

        public void Dispose() { handle.Dispose(); }

        /// <summary>Grid.Epoch when the view was taken.</summary>
        public ulong Epoch
        {
            get
            {
                ulong epoch;
                using (var use = handle.Read()) VoxException.Check(Native.vox_query_view_epoch(use.Pointer, &epoch));
                return epoch;
            }
        }

        /// <summary>The number that a mesh of the view was added with.</summary>
        public ulong GetUserData(Mesh mesh)
        {
            ulong userData;
            using (var use = handle.Read())
                VoxException.Check(Native.vox_query_view_user_data(use.Pointer, mesh.Id, &userData));
            return userData;
        }

        /// <summary>As Grid.QueryPoints.</summary>
        public ulong QueryPoints(ReadOnlySpan<double> points, Span<PointHit> hits, ulong mask = ulong.MaxValue)
        {
            ulong count;
            fixed (double* p = &MemoryMarshal.GetReference(points))
            fixed (PointHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
                VoxException.Check(Native.vox_query_view_points(use.Pointer, Grid.PointsOf(p), Format.Double, 0,
                                                                Grid.Count(points.Length, 3, "points"), mask, h,
                                                                (ulong)hits.Length, &count));
            return count;
        }

        /// <summary>As Grid.QueryClosest.</summary>
        public void QueryClosest(ReadOnlySpan<double> points, Span<ClosestHit> hits,
                                 double maxDistance = double.PositiveInfinity, ulong mask = ulong.MaxValue,
                                 Mesh excluded = default(Mesh))
        {
            ClosestDesc desc = Grid.DescribeClosest(points, hits.Length, maxDistance, mask, excluded);
            fixed (double* p = &MemoryMarshal.GetReference(points))
            fixed (ClosestHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
            {
                ClosestHit none;
                desc.points = (IntPtr)p;
                VoxException.Check(Native.vox_query_view_closest_points(use.Pointer, &desc, h == null ? &none : h));
            }
        }

        /// <summary>As Grid.QueryBox.</summary>
        public ulong QueryBox(Double3 min, Double3 max, Span<TetHit> hits, ulong mask = ulong.MaxValue)
        {
            ulong count;
            fixed (TetHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
                VoxException.Check(Native.vox_query_view_box(use.Pointer, (double*)&min, (double*)&max, mask, h,
                                                             (ulong)hits.Length, &count));
            return count;
        }

        /// <summary>As Grid.QueryRay.</summary>
        public RayHit QueryRay(Double3 from, Double3 to, ulong mask = ulong.MaxValue)
        {
            RayHit hit;
            using (var use = handle.Read())
                VoxException.Check(Native.vox_query_view_ray(use.Pointer, (double*)&from, (double*)&to, mask, &hit));
            return hit;
        }

        /// <summary>As Grid.QueryRayHits.</summary>
        public ulong QueryRayHits(Double3 from, Double3 to, Span<FacetHit> hits, ulong mask = ulong.MaxValue,
                                  Mesh excluded = default(Mesh))
        {
            ulong count;
            fixed (FacetHit* h = &MemoryMarshal.GetReference(hits))
            using (var use = handle.Read())
                VoxException.Check(Native.vox_query_view_ray_hits(use.Pointer, (double*)&from, (double*)&to, mask, excluded.Id,
                                                                  h, (ulong)hits.Length, &count));
            return count;
        }

        /// <summary>As Grid.QueryRayAny.</summary>
        public bool QueryRayAny(Double3 from, Double3 to, ulong mask = ulong.MaxValue, Mesh excluded = default(Mesh))
        {
            uint any;
            using (var use = handle.Read())
                VoxException.Check(Native.vox_query_view_ray_any(use.Pointer, (double*)&from, (double*)&to, mask, excluded.Id,
                                                                 &any));
            return any != 0;
        }
    }
}
