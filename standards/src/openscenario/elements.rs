//! The elements of ASAM OpenSCENARIO XML 1.0 to 1.3, and how each is supported.

use crate::xml::{Row, Schema, Supported, no_effect, read, refused};
use std::sync::LazyLock;

const OTHERS: &str = "it is data for other programs";
const AXLES: &str = "the box of an entity says where the entity is, and the model of the vehicle how it steers";
const LOOKS: &str = "the looks of entities follow from their classes";
const WEATHER: &str = "the weather of the file does not change the world yet";
const DRIVER: &str = "the system under test is the controller";
const SIGNALS: &str = "there are no traffic signals yet";
const SWARMS: &str = "there are no swarms of vehicles yet; name the entities one by one";
const TRAILERS: &str = "there are no trailers: vehicles drive without them";
const ROUTES: &str = "there are no routes yet; use a FollowTrajectoryAction, or a LanePosition";
const CURVES: &str = "use a Polyline, a Clothoid or a ClothoidSpline";
const PARAMETERS: &str = "parameters do not change during a run; use a VariableAction";
const COMMANDS: &str = "no file runs a command";
const NAMED: &str = "name the entities one by one";
const CONTROL: &str = "use an ActivateControllerAction";
const CHANCE: &str = "use a UniformDistribution, a NormalDistribution with a Range, or a ProbabilityDistributionSet";
const PROFILE: &str = "use a SpeedAction or a LongitudinalDistanceAction";
const LATERAL: &str = "use a LaneOffsetAction";
const PLACES: &str = "use a WorldPosition";
const ENTITIES: &str = "all entities are in the world from the beginning to the end";
const CONDITIONS: &str = "use a condition on time, speed, distance or the state of an element";

pub(super) const ROWS: &[Row] = &[
    read("OpenSCENARIO", "FileHeader", "author date description revMajor revMinor"),
    no_effect("FileHeader", "License", OTHERS),
    no_effect("FileHeader|MiscObject|Pedestrian|Vehicle", "Properties", OTHERS),
    read("Maneuver|MiscObject|OpenSCENARIO|Pedestrian|Story|Trajectory|Vehicle", "ParameterDeclarations", ""),
    read("ParameterDeclarations", "ParameterDeclaration", "name parameterType value"),
    read("ParameterDeclaration", "ConstraintGroup", ""),
    read("ConstraintGroup", "ValueConstraint", "rule value"),
    no_effect("OpenSCENARIO", "MonitorDeclarations", OTHERS),
    read("OpenSCENARIO", "CatalogLocations|RoadNetwork|Entities|Storyboard|ParameterValueDistribution", ""),
    read(
        "CatalogLocations",
        "VehicleCatalog|ControllerCatalog|PedestrianCatalog|MiscObjectCatalog|EnvironmentCatalog|ManeuverCatalog|TrajectoryCatalog|RouteCatalog",
        "",
    ),
    read(
        "ControllerCatalog|EnvironmentCatalog|ManeuverCatalog|MiscObjectCatalog|PedestrianCatalog|RouteCatalog|TrajectoryCatalog|VehicleCatalog",
        "Directory",
        "path",
    ),
    read("RoadNetwork", "LogicFile", "filepath"),
    no_effect("RoadNetwork", "SceneGraphFile|UsedArea", OTHERS),
    refused("RoadNetwork", "TrafficSignals", SIGNALS),
    read(
        "DistanceCondition|ReachPositionCondition|TeleportAction|TimeToCollisionConditionTarget|Vertex",
        "Position",
        "",
    ),
    read("Position|TargetPosition|TargetPositionMaster", "WorldPosition", "h p r x y z"),
    read(
        "Position|TargetPosition|TargetPositionMaster",
        "RelativeWorldPosition|RelativeObjectPosition",
        "entityRef dx dy dz",
    ),
    read(
        "LanePosition|RelativeLanePosition|RelativeObjectPosition|RelativeRoadPosition|RelativeWorldPosition|RoadPosition|TrajectoryPosition",
        "Orientation",
        "h p r type",
    ),
    read("Position|TargetPosition|TargetPositionMaster", "RoadPosition", "roadId s t"),
    read("Position|TargetPosition|TargetPositionMaster", "RelativeRoadPosition", "entityRef ds dt"),
    read("Position|TargetPosition|TargetPositionMaster", "LanePosition", "laneId offset roadId s"),
    read("Position|TargetPosition|TargetPositionMaster", "RelativeLanePosition", "entityRef dLane ds offset dsLane"),
    refused("Position|TargetPosition|TargetPositionMaster", "RoutePosition", ROUTES),
    refused("Catalog", "Route", ROUTES),
    refused("Position|TargetPosition|TargetPositionMaster", "GeoPosition", PLACES),
    read("FollowTrajectoryAction|TrajectoryPosition", "TrajectoryRef", ""),
    read("Catalog|FollowTrajectoryAction|TrajectoryRef", "Trajectory", "closed name"),
    read("Trajectory", "Shape", ""),
    read("Shape", "Polyline", ""),
    read("Polyline", "Vertex", "time"),
    read(
        "EnvironmentAction|FollowTrajectoryAction|ManeuverGroup|ObjectController|ScenarioObject|TrajectoryRef",
        "CatalogReference",
        "catalogName entryName",
    ),
    read("CatalogReference", "ParameterAssignments", ""),
    read("ParameterAssignments|ParameterValueSet", "ParameterAssignment", "parameterRef value"),
    read("Entities", "ScenarioObject", "name"),
    read("Catalog|ScenarioObject", "Vehicle", "name vehicleCategory role mass model3d"),
    read("MiscObject|Pedestrian|Vehicle", "BoundingBox", ""),
    read("BoundingBox", "Center", "x y z"),
    read("BoundingBox", "Dimensions", "height length width"),
    read("Vehicle", "Performance", "maxAcceleration maxAccelerationRate maxDeceleration maxDecelerationRate maxSpeed"),
    no_effect("Vehicle", "Axles", AXLES),
    no_effect("Vehicle", "TrailerHitch|TrailerCoupler", LOOKS),
    no_effect("Vehicle", "Trailer", TRAILERS),
    read("Catalog|ScenarioObject", "Pedestrian", "mass model name pedestrianCategory model3d role"),
    read("Catalog|ScenarioObject", "MiscObject", "mass miscObjectCategory name model3d"),
    refused("ScenarioObject", "ExternalObjectReference", NAMED),
    read("ScenarioObject", "ObjectController", "name"),
    no_effect("Catalog|ObjectController", "Controller", DRIVER),
    refused("Entities", "EntitySelection", NAMED),
    read("Actors|CollisionCondition|TimeToCollisionConditionTarget|TriggeringEntities", "EntityRef", "entityRef"),
    refused("CollisionCondition", "ByType", NAMED),
    read("Storyboard", "Init", ""),
    read("Init", "Actions", ""),
    read("Action|Actions", "GlobalAction", ""),
    read("GlobalAction", "EnvironmentAction", ""),
    no_effect("Catalog|EnvironmentAction", "Environment", WEATHER),
    refused("GlobalAction", "EntityAction", ENTITIES),
    refused("GlobalAction", "InfrastructureAction", SIGNALS),
    refused("GlobalAction", "TrafficAction", SWARMS),
    refused("Action|Actions", "UserDefinedAction", COMMANDS),
    read("Actions", "Private", "entityRef"),
    read("Action|Private", "PrivateAction", ""),
    read("PrivateAction", "LongitudinalAction|LateralAction|ControllerAction|TeleportAction|RoutingAction", ""),
    read("LongitudinalAction", "SpeedAction", ""),
    read("SpeedAction", "SpeedActionDynamics", "dynamicsDimension dynamicsShape followingMode value"),
    read("SpeedAction", "SpeedActionTarget", ""),
    read("SpeedActionTarget", "RelativeTargetSpeed", "entityRef continuous speedTargetValueType value"),
    read("SpeedActionTarget", "AbsoluteTargetSpeed", "value"),
    read(
        "LongitudinalAction",
        "LongitudinalDistanceAction",
        "entityRef continuous distance freespace timeGap displacement coordinateSystem",
    ),
    read(
        "LongitudinalDistanceAction",
        "DynamicConstraints",
        "maxAcceleration maxAccelerationRate maxDeceleration maxDecelerationRate maxSpeed",
    ),
    read("LateralAction", "LaneChangeAction", "targetLaneOffset"),
    read("LaneChangeAction", "LaneChangeActionDynamics", "dynamicsDimension dynamicsShape followingMode value"),
    read("LaneChangeAction", "LaneChangeTarget", ""),
    read("LaneChangeTarget", "RelativeTargetLane", "entityRef value"),
    read("LaneChangeTarget", "AbsoluteTargetLane", "value"),
    read("LateralAction", "LaneOffsetAction", "continuous"),
    read("LaneOffsetAction", "LaneOffsetActionDynamics", "dynamicsShape maxLateralAcc"),
    read("LaneOffsetAction", "LaneOffsetTarget", ""),
    read("LaneOffsetTarget", "RelativeTargetLaneOffset", "entityRef value"),
    read("LaneOffsetTarget", "AbsoluteTargetLaneOffset", "value"),
    refused("LateralAction", "LateralDistanceAction", LATERAL),
    no_effect("PrivateAction", "VisibilityAction|AppearanceAction", LOOKS),
    read(
        "ControllerAction|PrivateAction",
        "ActivateControllerAction",
        "controllerRef objectControllerRef lateral longitudinal animation lighting",
    ),
    refused("ControllerAction", "AssignControllerAction|OverrideControllerValueAction", CONTROL),
    refused("RoutingAction", "AssignRouteAction|AcquirePositionAction|RandomRouteAction", ROUTES),
    read("RoutingAction", "FollowTrajectoryAction", "initialDistanceOffset"),
    read("FollowTrajectoryAction", "TimeReference", ""),
    read("TimeReference", "None", ""),
    read("TimeReference", "Timing", "domainAbsoluteRelative offset scale"),
    no_effect("FollowTrajectoryAction", "TrajectoryFollowingMode", OTHERS),
    refused("PrivateAction", "TrailerAction", TRAILERS),
    read("Storyboard", "Story", "name"),
    read("Story", "Act", "name"),
    read("Act", "ManeuverGroup", "maximumExecutionCount name"),
    read("ManeuverGroup", "Actors", "selectTriggeringEntities"),
    read("Catalog|ManeuverGroup", "Maneuver", "name"),
    read("Maneuver", "Event", "maximumExecutionCount name priority"),
    read("Event", "Action", "name"),
    read("Act|Event", "StartTrigger", ""),
    read("StartTrigger|StopTrigger", "ConditionGroup", ""),
    read("ConditionGroup", "Condition", "conditionEdge delay name"),
    read("Condition", "ByEntityCondition|ByValueCondition", ""),
    read("ByEntityCondition", "TriggeringEntities", "triggeringEntitiesRule"),
    read("ByEntityCondition", "EntityCondition", ""),
    read("EntityCondition", "EndOfRoadCondition|StandStillCondition", "duration"),
    read("EntityCondition", "CollisionCondition", ""),
    refused(
        "EntityCondition",
        "OffroadCondition|RelativeClearanceCondition|AngleCondition|RelativeAngleCondition",
        CONDITIONS,
    ),
    read(
        "EntityCondition",
        "TimeHeadwayCondition",
        "entityRef alongRoute freespace rule value coordinateSystem relativeDistanceType routingAlgorithm",
    ),
    read(
        "EntityCondition",
        "TimeToCollisionCondition",
        "alongRoute freespace rule value relativeDistanceType coordinateSystem routingAlgorithm",
    ),
    read("TimeToCollisionCondition", "TimeToCollisionConditionTarget", ""),
    read("EntityCondition", "AccelerationCondition|SpeedCondition", "rule value direction"),
    read("EntityCondition", "RelativeSpeedCondition", "entityRef rule value direction"),
    read("EntityCondition", "TraveledDistanceCondition", "value"),
    read("EntityCondition", "ReachPositionCondition", "tolerance"),
    read(
        "EntityCondition",
        "DistanceCondition",
        "alongRoute freespace rule value coordinateSystem relativeDistanceType routingAlgorithm",
    ),
    read(
        "EntityCondition",
        "RelativeDistanceCondition",
        "entityRef freespace relativeDistanceType rule value coordinateSystem routingAlgorithm",
    ),
    read("ByValueCondition", "ParameterCondition", "parameterRef rule value"),
    refused("ByValueCondition", "TimeOfDayCondition", CONDITIONS),
    read("ByValueCondition", "SimulationTimeCondition", "rule value"),
    read("ByValueCondition", "StoryboardElementStateCondition", "storyboardElementRef state storyboardElementType"),
    refused("ByValueCondition", "UserDefinedValueCondition", COMMANDS),
    refused("ByValueCondition", "TrafficSignalCondition|TrafficSignalControllerCondition", SIGNALS),
    read("Act|Storyboard", "StopTrigger", ""),
    read("OpenSCENARIO", "Catalog", "name"),
    read("ParameterValueDistribution", "ScenarioFile", "filepath"),
    read("ParameterValueDistribution", "Deterministic", ""),
    read("Deterministic", "DeterministicMultiParameterDistribution", ""),
    read("DeterministicMultiParameterDistribution", "ValueSetDistribution", ""),
    read("ValueSetDistribution", "ParameterValueSet", ""),
    read("Deterministic", "DeterministicSingleParameterDistribution", "parameterName"),
    read("DeterministicSingleParameterDistribution", "DistributionSet", ""),
    read("DistributionSet", "Element", "value"),
    read("DeterministicSingleParameterDistribution", "DistributionRange", "stepWidth"),
    read("DistributionRange", "Range", "lowerLimit upperLimit"),
    refused("DeterministicSingleParameterDistribution", "UserDefinedDistribution", COMMANDS),
    read("ParameterValueDistribution", "Stochastic", ""),
    no_effect("Stochastic", "@numberOfTestRuns", "use the option --budget"),
    no_effect("Stochastic", "@randomSeed", "use the option --seed"),
    read("Stochastic", "StochasticDistribution", "parameterName"),
    read("StochasticDistribution", "UniformDistribution", ""),
    read("StochasticDistribution", "NormalDistribution", "expectedValue variance"),
    read("UniformDistribution|NormalDistribution", "Range", "lowerLimit upperLimit"),
    read("StochasticDistribution", "ProbabilityDistributionSet", ""),
    read("ProbabilityDistributionSet", "Element", "value weight"),
    refused("StochasticDistribution", "LogNormalDistribution|PoissonDistribution|Histogram", CHANCE),
    refused("StochasticDistribution", "UserDefinedDistribution", COMMANDS),
    read("OpenSCENARIO", "VariableDeclarations", ""),
    read("VariableDeclarations", "VariableDeclaration", "name variableType value"),
    read("GlobalAction", "VariableAction", "variableRef"),
    read("VariableAction", "SetAction", "value"),
    read("VariableAction", "ModifyAction", ""),
    read("ModifyAction", "Rule", ""),
    read("Rule", "AddValue", "value"),
    read("Rule", "MultiplyByValue", "value"),
    read("ByValueCondition", "VariableCondition", "variableRef rule value"),
    refused("GlobalAction", "ParameterAction", PARAMETERS),
    refused("GlobalAction", "SetMonitorAction", OTHERS),
    refused("LongitudinalAction", "SpeedProfileAction", PROFILE),
    read("PrivateAction", "SynchronizeAction", "masterEntityRef targetToleranceMaster targetTolerance"),
    read("SynchronizeAction", "TargetPositionMaster|TargetPosition|FinalSpeed", ""),
    read("FinalSpeed", "AbsoluteSpeed", "value"),
    read("AbsoluteSpeed", "TargetDistanceSteadyState", "distance"),
    read("AbsoluteSpeed", "TargetTimeSteadyState", "time"),
    refused("FinalSpeed", "RelativeSpeedToMaster", "use an AbsoluteSpeed"),
    read("TargetPosition|TargetPositionMaster", "TrajectoryPosition", "s t"),
    read("Shape", "Clothoid", "curvature curvaturePrime curvatureDot length startTime stopTime"),
    read("Clothoid", "Position", ""),
    read("Shape", "ClothoidSpline", "timeEnd"),
    read("ClothoidSpline", "ClothoidSplineSegment", "curvatureStart curvatureEnd length hOffset timeStart"),
    read("ClothoidSplineSegment", "PositionStart", ""),
    read("PositionStart", "WorldPosition|LanePosition|RoadPosition", "x y z h p r roadId laneId s t offset"),
    refused("Shape", "Nurbs", CURVES),
    refused("Position", "TrajectoryPosition", "use a LanePosition or a WorldPosition"),
];

/// The elements that occur at most once within their parent.
const ONCE: &[&str] = &[
    "FileHeader",
    "ParameterDeclarations",
    "CatalogLocations",
    "RoadNetwork",
    "Entities",
    "Storyboard",
    "Init",
    "StartTrigger",
    "StopTrigger",
    "BoundingBox",
    "Performance",
];

/// Returns the table of OpenSCENARIO.
pub(super) fn schema() -> &'static Schema {
    static SCHEMA: LazyLock<Schema> = LazyLock::new(|| Schema::new(ROWS, ONCE));
    &SCHEMA
}

/// Returns all elements of OpenSCENARIO, without the contents of elements that have no effect or are refused.
pub fn elements() -> impl Iterator<Item = Supported> {
    ROWS.iter().flat_map(Row::each)
}
