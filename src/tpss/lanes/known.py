"""What is decided in all cases that lanes cover."""
SAME_PARAMETERS = {"derivatives", "start", "with_slopes", "step", "step_s", "s", "n", "i", "warm", "scale", "number"}
SAME_FIELDS = {"size", "shape", "kind", "reactive_model", "voltage_model", "current_model", "profile",
  "efficiency.points","efficiency.first","curve.points","curve.first","adhesion.points","power_factor.points", "train_type","route","leg", "start_node","end_node","block_aa","block_ab","block_ba","block_bb",
  "node","upper","lower","pivot.first","pivot.end","update", "update", "first_section","end_section","line","controlled","installed",
  "options.step_s","options.mean_power","options.mean_gradient","options.adhesion_in_km_h","options.rail","options.driver","options.braking","options.motion","options.slope_change",
  "control.fixed_voltage_v","control.studied_train","network.tolerance", "place.train"}
SAME_ARRAYS = {"shape","source_of_node","places","row_start"}
DECIDED = {
 "options.motion == MotionModel.CONTINUOUS": False,
 "decision.course == Course.PASSAGE": False,
 "decision.course != Course.PASSAGE": True,
 "stores.size > 0": False,
 "control.has_stores": False,
 "effort.kind == EffortKind.NETWORK": True,
 "effort.kind == EffortKind.TABLE": False,
 "effort.kind == EffortKind.LIMITS": False,
 "line_current.highest_current_a < math.inf": False,
 "s == UNFED": False, "source_of_node[at(n)] == UNFED": False,
 "studied >= 0": False, "clock[0].unfed > 0": False, "fixed_voltage_v <= 0.0": True, "fixed_v > 0.0": False,
 "shape[0] > 0": False, "driver.address != 0": False, "own_resistance.address != 0": False, "over_load.count > 0": False,
 "address != 0": False, "options.braking == Braking.WITHIN_STEP": False,
 "signalling.separation != Separation.NONE": False,
 "s <= FOLLOWS": False,
 "source.kind == SourceKind.GRID": False,
 "source.kind == SourceKind.MIXED": False,
 "source.kind == SourceKind.BOUNDED": False,
 "source.kind == SourceKind.RECTIFIER": False,
 "source.kind == SourceKind.OWN": False,
 "source.kind == SourceKind.CONVERTER": True,
}
DECIDED_CALLS = {"asks_more": False, "is_unfed": False, "brakes_within_step": False, "has_store": False, "works_beyond_loads": False}
