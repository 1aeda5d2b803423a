using System;
using System.Runtime.ExceptionServices;
using System.Runtime.InteropServices;

namespace Voxtet
{
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
                CostWeights w = Sized(weights);
                var settings = new SuggestDesc { struct_size = (uint)sizeof(SuggestDesc), model = model, weights = &w };
                Suggestion suggestion;
                suggestion.struct_size = (uint)sizeof(Suggestion);
                fixed (MeshDesc* d = descs)
                    VoxException.Check(Native.vox_suggest_cell_size(&settings, d, (ulong)descs.Length, &suggestion));
                return suggestion;
            }
            finally
            {
                foreach (GCHandle pin in pins)
                    if (pin.IsAllocated) pin.Free();
            }
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
        static void Calling(Func<double, double> function, Use use)
        {
            var caller = new Caller { Cost = function };
            GCHandle user = GCHandle.Alloc(caller);
            try
            {
                Result result = use(Marshal.GetFunctionPointerForDelegate(call), GCHandle.ToIntPtr(user));
                if (caller.Error != null) caller.Error.Throw();
                VoxException.Check(result);
            }
            finally
            {
                user.Free();
            }
        }

        /// <summary>The method for any algorithm: the cell size between min and max of least cost. What the function throws
        /// goes on here. zoneLoss as GridDescription has it.</summary>
        public static CostMinimum Minimise(Func<double, double> cost, double min, double max, double zoneLoss = 0)
        {
            if (cost == null) throw new ArgumentNullException("cost");
            CostMinimum minimum;
            minimum.struct_size = (uint)sizeof(CostMinimum);
            CostMinimum* m = &minimum;
            Calling(cost, (function, user) => Native.vox_cost_minimise(function, user, min, max, zoneLoss, m));
            return minimum;
        }

        /// <summary>The best cell size for a grid that is described.</summary>
        public static ForeignSuggestion SuggestFor(GridDescription grid)
        {
            using (var described = new DescribedGrid(grid))
            {
                ForeignSuggestion suggestion;
                suggestion.struct_size = (uint)sizeof(ForeignSuggestion);
                VoxException.Check(Native.vox_suggest_for(described.Grid, &suggestion));
                return suggestion;
            }
        }

        /// <summary>What a run of a grid does at one cell size.</summary>
        public static GridWork CountFor(GridDescription grid, double cellSize)
        {
            using (var described = new DescribedGrid(grid))
            {
                GridWork work;
                VoxException.Check(Native.vox_count_for(described.Grid, cellSize, &work));
                return work;
            }
        }

        /// <summary>The weights of a grid, and its best cell size, from timings at three cell sizes or more.</summary>
        public static GridFit Fit(GridDescription grid, params GridTiming[] timings)
        {
            if (timings == null) throw new ArgumentNullException("timings");
            using (var described = new DescribedGrid(grid))
            fixed (GridTiming* t = timings)
            {
                GridFit fit;
                fit.struct_size = (uint)sizeof(GridFit);
                VoxException.Check(Native.vox_cost_fit(described.Grid, t, (ulong)timings.Length, &fit));
                return fit;
            }
        }

        /// <summary>Runs a grid at the cell sizes that tell most about the best one. The function runs it once and returns
        /// how many seconds that took: infinity if it cannot run at this size, NaN to stop. What it throws goes on here.
        /// Without a description the first cell size must be set: new TuneDesc { first = 0.1 }.</summary>
        public static Tuning Tune(Func<double, double> run, GridDescription grid = null, TuneDesc settings = default(TuneDesc))
        {
            if (run == null) throw new ArgumentNullException("run");
            settings.struct_size = (uint)sizeof(TuneDesc);
            Tuning tuning;
            tuning.struct_size = (uint)sizeof(Tuning);
            TuneDesc* d = &settings;
            Tuning* t = &tuning;
            using (DescribedGrid described = grid == null ? null : new DescribedGrid(grid))
            {
                ForeignGrid* g = described == null ? null : described.Grid;
                Calling(run, (function, user) => Native.vox_cost_tune(g, d, function, user, t));
            }
            return tuning;
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
            var settings = new SuggestDesc
            {
                struct_size = (uint)sizeof(SuggestDesc), model = model.GetValueOrDefault(), weights = weights.HasValue ? &w : null
            };
            Suggestion suggestion;
            suggestion.struct_size = (uint)sizeof(Suggestion);
            using (var use = handle.Read())
                VoxException.Check(Native.vox_grid_suggest_cell_size(use.Pointer, model.HasValue ? &settings : null,
                                                                     &suggestion));
            return suggestion;
        }
    }
}
