using System;
using System.Runtime.ExceptionServices;
using System.Runtime.InteropServices;

namespace Voxtet
{
    /// <summary>A cell size and the reasons for it. Costs are seconds of a step or a run; those of CostModel.Paper are visits of
    /// cells per tetrahedron, and those of CellSize.Minimise are the function's. What a call does not know is 0 or empty.
    /// </summary>
    public sealed class Suggestion
    {
        /// <summary>One kind of work: how often it is done at the cell size, and what that costs.</summary>
        public struct Term
        {
            public string Name;
            public double Count, Cost;
        }

        /// <summary>The cell size that a rule of thumb gives (0: the rule does not apply), and the cost there (0: not known).
        /// </summary>
        public struct Rule
        {
            public string Name;
            public double CellSize, Cost;
        }

        internal unsafe Suggestion(CellSizeResult* found)
        {
            CellSize = found->cell_size;
            ZoneMin = found->zone_min;
            ZoneMax = found->zone_max;
            Cost = found->cost;
            MinCellSize = found->min_cell_size;
            CellsPerAxis = found->cells_per_axis;
            FitError = found->fit_error;
            ExpectedLoss = found->expected_loss;
            Curve = new CostSample[found->curve_count];
            for (int i = 0; i < Curve.Length; ++i) Curve[i] = found->curve[i];
            Terms = new Term[found->term_count];
            for (int i = 0; i < Terms.Length; ++i)
            {
                CostTerm term = found->terms[i];
                Terms[i] = new Term { Name = VoxException.Text(term.name), Count = term.count, Cost = term.cost };
            }
            Rules = new Rule[found->rule_count];
            for (int i = 0; i < Rules.Length; ++i)
            {
                CellSizeRule rule = found->rules[i];
                Rules[i] = new Rule { Name = VoxException.Text(rule.name), CellSize = rule.cell_size, Cost = rule.cost };
            }
            Timings = new Timing[found->timing_count];
            for (int i = 0; i < Timings.Length; ++i) Timings[i] = found->timings[i];
            Weights = found->weights;
            Warnings = found->warnings;
            Note = found->note.ToString();
        }

        public double CellSize { get; private set; }

        /// <summary>The range around CellSize where the cost is at most 1 + the zone loss times the least.</summary>
        public double ZoneMin { get; private set; }
        public double ZoneMax { get; private set; }

        /// <summary>Predicted at CellSize.</summary>
        public double Cost { get; private set; }

        /// <summary>The smallest that gives right answers; 0: any.</summary>
        public double MinCellSize { get; private set; }

        /// <summary>Edge of the world divided by CellSize.</summary>
        public double CellsPerAxis { get; private set; }

        /// <summary>Of Fit and Tune: root mean square of (fitted time / measured time - 1).</summary>
        public double FitError { get; private set; }

        /// <summary>Of Tune: how much longer a run may take than at the best cell size; 0.03 means 3 %.</summary>
        public double ExpectedLoss { get; private set; }

        /// <summary>Ascending in the cell size.</summary>
        public CostSample[] Curve { get; private set; }

        /// <summary>Their costs add up to Cost.</summary>
        public Term[] Terms { get; private set; }

        public Rule[] Rules { get; private set; }

        /// <summary>Of Tune: the runs, in order.</summary>
        public Timing[] Timings { get; private set; }

        /// <summary>Of a described grid: those used, or those found by Fit and Tune.</summary>
        public ForeignWeights Weights { get; private set; }

        public CellSizeWarnings Warnings { get; private set; }

        /// <summary>The warnings in words, with numbers; "" if there are none.</summary>
        public string Note { get; private set; }
    }

    /// <summary>A cell size for anybody's grid, and the reasons for it.</summary>
    public static unsafe class CellSize
    {
        /// <summary>The cell size that minimises the cost model for a mesh: three numbers a vertex, four indices a
        /// tetrahedron. Weights are for the models of the engines, from Calibrate; null: those shipped with the library.
        /// </summary>
        public static Suggestion Suggest(ReadOnlySpan<float> positions, ReadOnlySpan<uint> tets,
                                         CostModel model = CostModel.Paper, CostWeights? weights = null)
        {
            return Suggest(new[] { positions.ToArray() }, new[] { tets.ToArray() }, model, weights);
        }

        /// <summary>The same for several meshes, positions[i] with tets[i].</summary>
        public static Suggestion Suggest(float[][] positions, uint[][] tets, CostModel model = CostModel.Paper,
                                         CostWeights? weights = null)
        {
            CostWeights w = Sized(weights);
            var settings = new CellSizeDesc { struct_size = (uint)sizeof(CellSizeDesc), model = model, weights = &w };
            CellSizeDesc* s = &settings;
            return Ask(found => Describe(positions, tets, (d, n) => Native.vox_suggest_cell_size(s, d, n, found)));
        }

        /// <summary>Sizes in meshes, positions[i] with tets[i].</summary>
        public static Geometry MeasureGeometry(float[][] positions, uint[][] tets)
        {
            Geometry geometry;
            geometry.struct_size = (uint)sizeof(Geometry);
            Geometry* g = &geometry;
            VoxException.Check(Describe(positions, tets, (d, n) => Native.vox_measure_geometry(d, n, g)));
            return geometry;
        }

        delegate Result UseMeshes(MeshDesc* descs, ulong count);

        /// <summary>Makes a call with descriptions of the meshes.</summary>
        static Result Describe(float[][] positions, uint[][] tets, UseMeshes use)
        {
            if (positions == null) throw new ArgumentNullException("positions");
            if (tets == null) throw new ArgumentNullException("tets");
            if (positions.Length != tets.Length)
                throw new ArgumentException(tets.Length + " arrays of tets, expected " + positions.Length, "tets");
            VoxException.CheckLibrary();
            var descs = new MeshDesc[positions.Length];
            var pins = new GCHandle[2 * positions.Length];
            try
            {
                for (int i = 0; i < descs.Length; ++i)
                {
                    if (positions[i] == null || tets[i] == null) throw new ArgumentNullException("mesh " + i);
                    if (positions[i].Length % 3 != 0 || tets[i].Length % 4 != 0)
                        throw new ArgumentException("mesh " + i + " has " + positions[i].Length + " numbers and " +
                                                    tets[i].Length + " indices, expected 3 a vertex and 4 a tetrahedron");
                    pins[2 * i] = GCHandle.Alloc(positions[i], GCHandleType.Pinned);
                    pins[2 * i + 1] = GCHandle.Alloc(tets[i], GCHandleType.Pinned);
                    descs[i].struct_size = (uint)sizeof(MeshDesc);
                    descs[i].positions.data = pins[2 * i].AddrOfPinnedObject();
                    descs[i].positions.count = (ulong)positions[i].Length / 3;
                    descs[i].tets = (uint*)pins[2 * i + 1].AddrOfPinnedObject();
                    descs[i].tet_count = (ulong)tets[i].Length / 4;
                }
                fixed (MeshDesc* d = descs) return use(d, (ulong)descs.Length);
            }
            finally
            {
                foreach (GCHandle pin in pins)
                    if (pin.IsAllocated) pin.Free();
            }
        }

        internal delegate Result Fill(CellSizeResult* found);

        /// <summary>What a call of the library finds.</summary>
        internal static Suggestion Ask(Fill fill)
        {
            CellSizeResult found;
            found.struct_size = (uint)sizeof(CellSizeResult);
            VoxException.Check(fill(&found));
            return new Suggestion(&found);
        }

        // As the library reads them: zeros are those shipped with it.
        internal static CostWeights Sized(CostWeights? weights)
        {
            CostWeights sized = weights.GetValueOrDefault();
            sized.struct_size = (uint)sizeof(CostWeights);
            return sized;
        }

        /// <summary>Measures the weights of the models of the engines on this machine, in about ten milliseconds.</summary>
        public static CostWeights Calibrate()
        {
            CostWeights weights = Sized(null);
            VoxException.Check(Native.vox_cost_calibrate(&weights));
            return weights;
        }

        sealed class Caller
        {
            internal Func<double, double> Cost;
            internal ExceptionDispatchInfo Error;
        }

        static readonly CostFunction call = Call; // never collected

        [AOT.MonoPInvokeCallback(typeof(CostFunction))]
        static double Call(double cellSize, IntPtr user)
        {
            var caller = (Caller)GCHandle.FromIntPtr(user).Target;
            if (caller.Error != null) return double.NaN;
            try
            {
                return caller.Cost(cellSize);
            }
            catch (Exception error) // goes on in Calling
            {
                caller.Error = ExceptionDispatchInfo.Capture(error); // with its stack trace
                return double.NaN;
            }
        }

        delegate Result Use(IntPtr function, IntPtr user);

        /// <summary>Makes a call of the library that calls the function, whose exception goes on here.</summary>
        static Result Calling(Func<double, double> function, Use use)
        {
            var caller = new Caller { Cost = function };
            GCHandle user = GCHandle.Alloc(caller);
            try
            {
                Result result = use(Marshal.GetFunctionPointerForDelegate(call), GCHandle.ToIntPtr(user));
                if (caller.Error != null) caller.Error.Throw();
                return result;
            }
            finally
            {
                user.Free();
            }
        }

        /// <summary>The method for any algorithm: the cell size between min and max of least cost. What the function throws
        /// goes on here. zoneLoss as GridDescription has it.</summary>
        public static Suggestion Minimise(Func<double, double> cost, double min, double max, double zoneLoss = 0)
        {
            if (cost == null) throw new ArgumentNullException("cost");
            return Ask(found => Calling(cost, (f, user) => Native.vox_cost_minimise(f, user, min, max, zoneLoss, found)));
        }

        /// <summary>The cell size with the least cost for a described grid.</summary>
        public static Suggestion Suggest(GridDescription grid)
        {
            using (var described = new DescribedGrid(grid))
                return Ask(found => Native.vox_foreign_grid_suggest(described.Grid, found));
        }

        /// <summary>How often a run of a grid does what at a cell size.</summary>
        public static ForeignCounts Count(GridDescription grid, double cellSize)
        {
            using (var described = new DescribedGrid(grid))
            {
                ForeignCounts counts;
                VoxException.Check(Native.vox_foreign_grid_count(described.Grid, cellSize, &counts));
                return counts;
            }
        }

        /// <summary>The weights of a grid, and its best cell size, from timings at three cell sizes or more.</summary>
        public static Suggestion Fit(GridDescription grid, params Timing[] timings)
        {
            if (timings == null) throw new ArgumentNullException("timings");
            using (var described = new DescribedGrid(grid))
            fixed (Timing* first = timings)
            {
                Timing* t = first;
                return Ask(found => Native.vox_foreign_grid_fit(described.Grid, t, (ulong)timings.Length, found));
            }
        }

        /// <summary>Runs a grid at the cell sizes that tell most about the best one. The function runs it once and returns
        /// how many seconds that took: infinity if it cannot run at this size, NaN to stop. What it throws goes on here.
        /// Without a description the first cell size must be set: new TuneDesc { first = 0.1 }.</summary>
        public static Suggestion Tune(Func<double, double> run, GridDescription grid = null, TuneDesc settings = default(TuneDesc))
        {
            if (run == null) throw new ArgumentNullException("run");
            settings.struct_size = (uint)sizeof(TuneDesc);
            TuneDesc* s = &settings;
            using (DescribedGrid described = grid == null ? null : new DescribedGrid(grid))
            {
                ForeignGrid* g = described == null ? null : described.Grid;
                return Ask(found => Calling(run, (f, user) => Native.vox_foreign_grid_tune(g, s, f, user, found)));
            }
        }
    }

    public sealed unsafe partial class Grid
    {
        /// <summary>The cell size that minimises a cost model for the meshes of this grid; without one, that of its engine.
        /// Weights need a model; null: those of GridOptions.Reference.</summary>
        public Suggestion SuggestCellSize(CostModel? model = null, CostWeights? weights = null)
        {
            if (weights.HasValue && !model.HasValue) throw new ArgumentException("weights need a model", "weights");
            CostWeights w = Voxtet.CellSize.Sized(weights);
            var settings = new CellSizeDesc
            {
                struct_size = (uint)sizeof(CellSizeDesc), model = model.GetValueOrDefault(),
                weights = weights.HasValue ? &w : null
            };
            CellSizeDesc* s = model.HasValue ? &settings : null;
            using (var use = handle.Read())
            {
                IntPtr grid = use.Pointer;
                return Voxtet.CellSize.Ask(found => Native.vox_grid_suggest_cell_size(grid, s, found));
            }
        }
    }
}
