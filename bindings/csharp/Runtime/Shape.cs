using System;
using System.Runtime.InteropServices;

namespace Voxtet
{
    /// <summary>A rigid shape for Grid.AddShape, in a frame of its own: Grid.SetTransform places it. Lengths may be 0. Arrays are
    /// copied when it is added. Experimental.</summary>
    public sealed class Shape
    {
        static readonly double[] noNumbers = new double[0];
        static readonly uint[] noIndices = new uint[0];

        internal readonly ShapeKind Kind;
        internal double Radius, HalfLength, SpacingX, SpacingY;
        internal Double3 HalfSize;
        internal double[] Positions = noNumbers, Heights = noNumbers;
        internal uint[] Triangles = noIndices;
        internal uint Columns;
        internal FieldFunction Function;

        Shape(ShapeKind kind) { Kind = kind; }

        /// <summary>All z up to 0: a floor.</summary>
        public static Shape HalfSpace() { return new Shape(ShapeKind.HalfSpace); }

        /// <summary>A ball around the origin.</summary>
        public static Shape Sphere(double radius) { return new Shape(ShapeKind.Sphere) { Radius = radius }; }

        /// <summary>Along the z axis, around the origin; halfLength is half the distance between the centres of its round ends.
        /// </summary>
        public static Shape Capsule(double radius, double halfLength)
        {
            return new Shape(ShapeKind.Capsule) { Radius = radius, HalfLength = halfLength };
        }

        /// <summary>Along the z axis, around the origin, with flat ends.</summary>
        public static Shape Cylinder(double radius, double halfLength)
        {
            return new Shape(ShapeKind.Cylinder) { Radius = radius, HalfLength = halfLength };
        }

        /// <summary>Around the origin, by half its sides.</summary>
        public static Shape Box(double halfX, double halfY, double halfZ)
        {
            return new Shape(ShapeKind.Box) { HalfSize = new Double3 { x = halfX, y = halfY, z = halfZ } };
        }

        /// <summary>Terrain, solid below: heights row after row, at x = column * spacingX, y = row * spacingY. Between four are two
        /// triangles, with the diagonal from the lower left to the upper right.</summary>
        public static Shape Heightfield(double[] heights, uint columns, double spacingX, double spacingY)
        {
            if (heights == null) throw new ArgumentNullException("heights");
            if (columns == 0 || heights.Length % columns != 0)
                throw new ArgumentException(heights.Length + " heights in rows of " + columns, "heights");
            return new Shape(ShapeKind.Heightfield)
            {
                Heights = heights, Columns = columns, SpacingX = spacingX, SpacingY = spacingY
            };
        }

        /// <summary>The inside of a closed surface: three numbers a vertex, three vertices a triangle, counter-clockwise as seen from
        /// outside.</summary>
        public static Shape Solid(double[] positions, uint[] triangles)
        {
            return OfTriangles(ShapeKind.Solid, positions, triangles, 0);
        }

        /// <summary>What is within a radius of triangles: a blade, a wall. It has two sides.</summary>
        public static Shape Sheet(double[] positions, uint[] triangles, double radius = 0)
        {
            return OfTriangles(ShapeKind.Sheet, positions, triangles, radius);
        }

        /// <summary>What is within a radius of the segments between positions, one after the other: a needle, a thread.</summary>
        public static Shape Polyline(double[] positions, double radius = 0)
        {
            if (positions == null) throw new ArgumentNullException("positions");
            uint count = (uint)Math.Max(positions.Length / 3 - 1, 0);
            var segments = new uint[3 * count];
            for (uint i = 0; i < count; ++i)
            {
                segments[3 * i] = i;
                segments[3 * i + 1] = segments[3 * i + 2] = i + 1;
            }
            return OfTriangles(ShapeKind.Sheet, positions, segments, radius);
        }

        /// <summary>Where a function is not positive, in a box around the origin that has half these sides.</summary>
        public static Shape Field(FieldFunction field, double halfX, double halfY, double halfZ)
        {
            if (field == null) throw new ArgumentNullException("field");
            return new Shape(ShapeKind.Field) { Function = field, HalfSize = new Double3 { x = halfX, y = halfY, z = halfZ } };
        }

        static Shape OfTriangles(ShapeKind kind, double[] positions, uint[] triangles, double radius)
        {
            if (positions == null) throw new ArgumentNullException("positions");
            if (triangles == null) throw new ArgumentNullException("triangles");
            Grid.Count(positions.Length, 3, "positions");
            Grid.Count(triangles.Length, 3, "triangles");
            return new Shape(kind) { Positions = positions, Triangles = triangles, Radius = radius };
        }
    }

    public sealed unsafe partial class Grid
    {
        /// <summary>Adds a rigid shape, which takes part from the next step on. The vertices of meshes collide with it. Its
        /// constraints have vertices of body_a alone. What is returned is good wherever a shape has what a mesh has:
        /// transform, filter, user data, whether it is enabled. Experimental.</summary>
        public Body AddShape(Shape shape, ulong userData = 0, Filter filter = default(Filter))
        {
            if (shape == null) throw new ArgumentNullException("shape");
            uint body;
            fixed (double* p = shape.Positions)
            fixed (double* h = shape.Heights)
            fixed (uint* t = shape.Triangles)
            using (var use = handle.Change())
            {
                var desc = new ShapeDesc
                {
                    struct_size = (uint)sizeof(ShapeDesc), kind = shape.Kind, radius = shape.Radius, half_length = shape.HalfLength,
                    half_size = shape.HalfSize, positions = PositionsOf<double>(shape.Positions, "positions"), triangles = t,
                    triangle_count = (ulong)shape.Triangles.Length / 3, heights = h, columns = shape.Columns,
                    rows = shape.Columns == 0 ? 0 : (uint)shape.Heights.Length / shape.Columns, user_data = userData, filter = filter
                };
                desc.positions.data = (IntPtr)p;
                desc.spacing[0] = shape.SpacingX;
                desc.spacing[1] = shape.SpacingY;
                if (shape.Function == null)
                {
                    VoxException.Check(Native.vox_shape_insert(use.Pointer, &desc, &body));
                    return new Body(body);
                }
                GCHandle field = GCHandle.Alloc(shape.Function);
                desc.field = Marshal.GetFunctionPointerForDelegate(FieldCall.Call);
                desc.field_user = GCHandle.ToIntPtr(field);
                Result result = Native.vox_shape_insert(use.Pointer, &desc, &body);
                if (result == Result.Ok) handle.KeepField(body, field);
                else field.Free();
                VoxException.Check(result);
            }
            return new Body(body);
        }

        /// <summary>Says where a shape was before, as in SetTransform; none: it stands still. In the following steps it moves from
        /// there to its transform, and they also find impacts with it. Experimental.</summary>
        public void SetPreviousTransform(Body shape, ReadOnlySpan<double> matrix)
        {
            CheckMatrix(matrix);
            fixed (double* m = &MemoryMarshal.GetReference(matrix))
            using (var use = handle.Change())
                VoxException.Check(Native.vox_shape_set_previous_transform(use.Pointer, shape.Id, m));
        }
    }
}
