using System;

namespace Voxtet.Tests
{
    /// <summary>Rigid shapes: each kind, and where it is and was.</summary>
    static class Shapes
    {
        static readonly double[] corners = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 };
        static readonly uint[] sides = { 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3 };
        static readonly uint[] noTets = new uint[0];

        static double[] At(double z) { return new[] { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, z }; }

        static void Near(double found, double expected, string what)
        {
            Test.That(Math.Abs(found - expected) < 1e-12, what + ": " + found + ", expected " + expected);
        }

        static void Touches(ShapeKind kind, Shape shape, double x, double y, double z, double gap, int axis, double sign)
        {
            using (var grid = new Grid(new GridOptions { Flags = GridFlags.Constraints }))
            {
                Body point = grid.Add(new[] { x, y, z, 2, 3, 4 }, noTets);
                Body body = grid.AddShape(shape, 7);
                grid.Step();
                Test.Same(grid.Constraints.Length, 1, kind + ": constraints");
                Constraint c = grid.Constraints[0];
                Test.That(c.body_a == point.Id && c.body_b == body.Id && c.user_data_b == 7, kind + ": bodies");
                Test.That(c.count == 1 && c.count_a == 1 && c.vertices[0] == 0, kind + ": vertices");
                Near(c.gap, gap, kind + ": gap");
                for (int k = 0; k < 3; ++k) Near(c.normal[k], k == axis ? sign : 0, kind + ": normal");
                Test.Same(grid.GetFacts(body).Shape, kind, "shape");
                Test.Same(grid.GetFacts(point).Shape, ShapeKind.None, "mesh");
                Test.Same(grid.GetUserData(body), 7ul, "user data");
            }
        }

        public static void EachKind()
        {
            Touches(ShapeKind.HalfSpace, Shape.HalfSpace(), 3, 4, -0.25, -0.25, 2, 1);
            Touches(ShapeKind.Sphere, Shape.Sphere(1), 0.5, 0, 0, -0.5, 0, 1);
            Touches(ShapeKind.Capsule, Shape.Capsule(0.5, 1), 0.25, 0, 1, -0.25, 0, 1);
            Touches(ShapeKind.Cylinder, Shape.Cylinder(0.5, 1), 0, 0.25, 0.5, -0.25, 1, 1);
            Touches(ShapeKind.Box, Shape.Box(1, 0.5, 2), 0, -0.25, 0, -0.25, 1, -1);
            Touches(ShapeKind.Heightfield, Shape.Heightfield(new[] { -.5, -.5, -.5, -.5, -.5, -.5 }, 3, 1, 2), 1, 1, -0.75, -0.25, 2, 1);
            Touches(ShapeKind.Solid, Shape.Solid(corners, sides), 0.25, 0.25, 0.125, -0.125, 2, -1);
            Touches(ShapeKind.Sheet, Shape.Sheet(corners, sides, 0.25), 0.25, 0.25, -0.125, -0.125, 2, -1);
            Touches(ShapeKind.Sheet, Shape.Polyline(new double[] { 0, 0, 0, 1, 0, 0 }, 0.25), 0.5, 0, -0.125, -0.125, 2, -1);
        }

        public static void Motion()
        {
            using (var grid = new Grid(new GridOptions { Flags = GridFlags.Constraints }))
            {
                grid.Add(new double[] { 0, 0, 3 }, noTets);
                Body ball = grid.AddShape(Shape.Sphere(0.25));
                grid.SetTransform(ball, At(6));
                grid.SetPreviousTransform(ball, At(0));
                grid.Step();
                Test.Same(grid.Constraints[0].kind, ConstraintKind.Impact, "kind");
                Test.That(Math.Abs(grid.Constraints[0].time - 2.75 / 6) < 1e-9, "time");
                grid.SetPreviousTransform(ball, default(ReadOnlySpan<double>));
                grid.Step();
                Test.Same(grid.Constraints.Length, 0, "constraints of a shape that stands still");
                grid.Remove(ball);
                Test.Throws<VoxException>(() => grid.SetPreviousTransform(ball, At(0)), "");
            }
        }

        public static void Field()
        {
            using (var grid = new Grid(new GridOptions { Flags = GridFlags.Constraints }))
            {
                grid.Add(new[] { 0, 0, 0.75 }, noTets);
                Body ball = grid.AddShape(Shape.Field((Double3 at, out Double3 gradient) =>
                {
                    gradient = at;
                    return Math.Sqrt(at.x * at.x + at.y * at.y + at.z * at.z) - 1;
                }, 1, 1, 1));
                Collect();
                grid.Step();
                Test.Same(grid.Constraints.Length, 1, "constraints");
                Test.That(Math.Abs(grid.Constraints[0].gap + 0.25) < 1e-9, "gap");
                grid.Remove(ball);
                grid.AddShape(Shape.Field((Double3 at, out Double3 gradient) => { throw new Exception("no distance"); }, 1, 1, 1));
                Test.Throws<VoxException>(() => grid.Step(), "the field of a shape has distance nan");
                Test.Throws<VoxArgumentException>(() => grid.AddShape(Shape.Field((Double3 at, out Double3 g) => { g = at; return 1; }, -1, 1, 1)),
                                                  "half_size");
            }
        }

        static void Collect()
        {
            GC.Collect();
            GC.WaitForPendingFinalizers();
        }

        public static void Refused()
        {
            using (var grid = new Grid())
            {
                Body point = grid.Add(new double[] { 0, 0, 3 }, noTets), ball = grid.AddShape(Shape.Sphere(0.25));
                Test.Throws<ArgumentNullException>(() => grid.AddShape(null), "");
                Test.Throws<VoxArgumentException>(() => grid.AddShape(Shape.Sphere(-1)), "radius is -1");
                Test.Throws<VoxArgumentException>(() => grid.AddShape(Shape.Solid(corners, noTets)), "triangle_count is 0");
                Test.Throws<VoxArgumentException>(() => grid.AddShape(Shape.Polyline(new double[3])), "triangle_count is 0");
                Test.Throws<VoxArgumentException>(() => grid.AddShape(Shape.Sheet(corners, new uint[] { 0, 1, 9 })), "vertex 9 of 4");
                Test.Throws<ArgumentNullException>(() => Shape.Solid(corners, null), "");
                Test.Throws<ArgumentNullException>(() => Shape.Polyline(null), "");
                Test.Throws<ArgumentNullException>(() => Shape.Heightfield(null, 1, 1, 1), "");
                Test.Throws<ArgumentException>(() => Shape.Solid(corners, new uint[4]), "4 numbers, expected 3");
                Test.Throws<ArgumentException>(() => Shape.Sheet(new double[4], sides), "4 numbers, expected 3");
                Test.Throws<ArgumentException>(() => Shape.Heightfield(new double[5], 2, 1, 1), "5 heights in rows of 2");
                Test.Throws<ArgumentException>(() => Shape.Heightfield(new double[5], 0, 1, 1), "rows of 0");
                Test.Throws<VoxArgumentException>(() => grid.SetPreviousTransform(point, At(0)), "");
                Test.Throws<ArgumentException>(() => grid.SetPreviousTransform(ball, new double[3]), "3 numbers, expected 12");
            }
        }
    }
}
