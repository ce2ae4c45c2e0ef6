//! The elements of ASAM OpenSCENARIO XML 1.0 to 1.3, and how each is supported.

use crate::xml::{Choice, Counts, Form, Row, Schema, Supported, no_effect, read, refused};
use std::sync::LazyLock;

const OTHERS: &str = "it is data for other programs";
const AXLES: &str = "the box of an entity says where the entity is, and the model of the vehicle how it steers";
const LOOKS: &str = "the looks of entities follow from their classes";
const AIR: &str = "the air has no temperature, no pressure and no wind";
const CLOUDS: &str = "the sky is clear; the light follows from the Sun";
const FOG: &str = "the fog is everywhere";
const WETNESS: &str = "the frictionScaleFactor says how slippery the road is";
const DRIVER: &str = "the system under test is the controller";
const SIGNALS: &str = "there are no traffic signals yet";
const SWARMS: &str = "there are no swarms of vehicles yet; name the entities one by one";
const TRAILERS: &str = "there are no trailers: vehicles drive without them";
const ROUTES: &str = "use an AssignRouteAction";
const COMMANDS: &str = "no file runs a command";
const NAMED: &str = "name the entities one by one";
const CONTROL: &str = "use an ActivateControllerAction";
const PLACES: &str = "use a WorldPosition";
const FLAT: &str = "the world is flat, and bodies stand on the ground";
const FLAT_ANGLES: &str = "the world is flat, so pitch and roll are 0";
const ALL_SEEN: &str = "sensors and drivers see all entities";
const ALWAYS_SHORTEST: &str = "routes are the shortest ones";
const EXACT: &str = "entities follow their actions exactly; use a SpeedProfileAction for limits";
const LIMITS: &str = "the changes of accelerations have no limit, but for those of a SpeedProfileAction";

/// The roles of vehicles and pedestrians.
const ROLES: Form = Form::OneOf("none|ambulance|civil|fire|military|police|publicTransport|roadAssistance");
/// The ways to follow a target.
const FOLLOWING: Form = Form::OneOf("follow|position");
/// The ways to choose a route for a distance along the road.
const ROUTING: Form = Form::OneOf("assignedRoute|fastest|leastIntersections|shortest|undefined");

pub(super) const ROWS: &[Row] = &[
    read("OpenSCENARIO!", "FileHeader", "author! date! description! revMajor! revMinor!"),
    no_effect("FileHeader", "License", OTHERS),
    no_effect("FileHeader|MiscObject|Pedestrian|RoadCondition|Vehicle", "Properties", OTHERS),
    read(
        "Environment|Maneuver|MiscObject|OpenSCENARIO|Pedestrian|Route|Story|Trajectory|Vehicle",
        "ParameterDeclarations",
        "",
    ),
    read("ParameterDeclarations", "ParameterDeclaration", "name! parameterType! value!").several(),
    read("ParameterDeclaration", "ConstraintGroup", "").several(),
    read("ConstraintGroup!", "ValueConstraint", "rule! value!").several(),
    no_effect("OpenSCENARIO", "MonitorDeclarations", OTHERS),
    read("OpenSCENARIO", "CatalogLocations|RoadNetwork|Entities|Storyboard|ParameterValueDistribution", ""),
    read(
        "CatalogLocations",
        "VehicleCatalog|ControllerCatalog|PedestrianCatalog|MiscObjectCatalog|EnvironmentCatalog|ManeuverCatalog|TrajectoryCatalog|RouteCatalog",
        "",
    ),
    read(
        "ControllerCatalog!|EnvironmentCatalog!|ManeuverCatalog!|MiscObjectCatalog!|PedestrianCatalog!|RouteCatalog!|TrajectoryCatalog!|VehicleCatalog!",
        "Directory",
        "path!",
    ),
    read("RoadNetwork", "LogicFile", "filepath!"),
    no_effect("RoadNetwork", "SceneGraphFile|UsedArea", OTHERS),
    refused("RoadNetwork", "TrafficSignals", SIGNALS),
    read(
        "AcquirePositionAction!|AddEntityAction!|DistanceCondition!|ReachPositionCondition!|TeleportAction!|TimeToCollisionConditionTarget|Vertex!|Waypoint!",
        "Position",
        "",
    ),
    read("Position|TargetPosition|TargetPositionMaster", "WorldPosition", "h p r x! y! z"),
    no_effect("WorldPosition", "@p|@r|@z", FLAT).valued(Form::Number, "0"),
    read(
        "Position|TargetPosition|TargetPositionMaster",
        "RelativeWorldPosition|RelativeObjectPosition",
        "entityRef! dx! dy! dz",
    ),
    no_effect("RelativeWorldPosition|RelativeObjectPosition", "@dz", FLAT).valued(Form::Number, "0"),
    read(
        "LanePosition|RelativeLanePosition|RelativeObjectPosition|RelativeRoadPosition|RelativeWorldPosition|RoadPosition|RoutePosition|TrajectoryPosition",
        "Orientation",
        "h p r type",
    ),
    no_effect("Orientation", "@p|@r", FLAT).valued(Form::Number, "0"),
    read("Position|TargetPosition|TargetPositionMaster", "RoadPosition", "roadId! s! t!"),
    read("Position|TargetPosition|TargetPositionMaster", "RelativeRoadPosition", "entityRef! ds! dt!"),
    read("Position|TargetPosition|TargetPositionMaster", "LanePosition", "laneId! offset roadId! s!"),
    read("Position|TargetPosition|TargetPositionMaster", "RelativeLanePosition", "entityRef! dLane! ds offset dsLane"),
    read("Position|TargetPosition|TargetPositionMaster", "RoutePosition", ""),
    read("RoutePosition!", "RouteRef|InRoutePosition", ""),
    read("InRoutePosition", "FromLaneCoordinates", "laneId! laneOffset pathS!"),
    read("InRoutePosition", "FromRoadCoordinates", "pathS! t!"),
    read("InRoutePosition", "FromCurrentEntity", "entityRef!"),
    read("AssignRouteAction|Catalog|RouteRef", "Route", "closed! name!").several(),
    read("Route!", "Waypoint", "routeStrategy!").several(),
    no_effect("Waypoint", "@routeStrategy", ALWAYS_SHORTEST)
        .valued(Form::OneOf("fastest|leastIntersections|random|shortest"), "shortest"),
    refused("Position|TargetPosition|TargetPositionMaster", "GeoPosition", PLACES),
    read("FollowTrajectoryAction|TrajectoryPosition!", "TrajectoryRef", ""),
    read("Catalog|FollowTrajectoryAction|TrajectoryRef", "Trajectory", "closed! name!").several(),
    read("Trajectory!", "Shape", ""),
    read("Shape", "Polyline", ""),
    read("Polyline!", "Vertex", "time").several(),
    read(
        "AssignRouteAction|EnvironmentAction|FollowTrajectoryAction|ObjectController|RouteRef|ScenarioObject|TrajectoryRef",
        "CatalogReference",
        "catalogName! entryName!",
    ),
    read("ManeuverGroup", "CatalogReference", "catalogName! entryName!").several(),
    read("CatalogReference", "ParameterAssignments", ""),
    read("ParameterAssignments|ParameterValueSet!", "ParameterAssignment", "parameterRef! value!").several(),
    read("Entities", "ScenarioObject", "name!").several(),
    read("Catalog|ScenarioObject", "Vehicle", "name! vehicleCategory! role mass model3d").several(),
    read("MiscObject!|Pedestrian!|Vehicle!", "BoundingBox", ""),
    read("BoundingBox!", "Center", "x! y! z!"),
    read("BoundingBox!", "Dimensions", "height! length! width!"),
    read(
        "Vehicle!",
        "Performance",
        "maxAcceleration! maxAccelerationRate maxDeceleration! maxDecelerationRate maxSpeed!",
    ),
    no_effect("Performance", "@maxAccelerationRate|@maxDecelerationRate", LIMITS).valued(Form::Number, ""),
    no_effect("MiscObject|Pedestrian|Vehicle", "@model3d", LOOKS),
    no_effect("Pedestrian", "@model", LOOKS),
    no_effect("Pedestrian|Vehicle", "@role", LOOKS).valued(ROLES, "none"),
    no_effect("Vehicle!", "Axles", AXLES),
    no_effect("Vehicle", "TrailerHitch|TrailerCoupler", LOOKS),
    no_effect("Vehicle", "Trailer", TRAILERS),
    read("Catalog|ScenarioObject", "Pedestrian", "mass! model name! pedestrianCategory! model3d role").several(),
    read("Catalog|ScenarioObject", "MiscObject", "mass! miscObjectCategory! name! model3d").several(),
    refused("ScenarioObject", "ExternalObjectReference", NAMED),
    read("ScenarioObject", "ObjectController", "name").several(),
    no_effect("Catalog|ObjectController", "Controller", DRIVER).several(),
    read("Entities", "EntitySelection", "name!").several(),
    read("EntitySelection!", "Members", ""),
    read("Members", "ByType", "objectType!").several(),
    read(
        "Actors|CollisionCondition|Members|TimeToCollisionConditionTarget|TriggeringEntities!",
        "EntityRef",
        "entityRef!",
    )
    .several(),
    read("CollisionCondition", "ByType", "type!"),
    read("Storyboard!", "Init", ""),
    read("Init!", "Actions", ""),
    read("Action|Actions", "GlobalAction", "").several(),
    read("GlobalAction", "EnvironmentAction", ""),
    read("Catalog|EnvironmentAction", "Environment", "name!").several(),
    read("Environment", "TimeOfDay", "animation! dateTime!"),
    read("Environment", "Weather", ""),
    no_effect("Weather", "@cloudState|@fractionalCloudCover|DomeImage", CLOUDS),
    no_effect("Weather", "@atmosphericPressure|@temperature|Wind", AIR),
    read("Weather", "Sun", "azimuth! elevation! illuminance intensity"),
    read("Weather", "Fog", "visualRange!"),
    no_effect("Fog", "BoundingBox", FOG),
    read("Weather", "Precipitation", "intensity precipitationIntensity precipitationType!"),
    read("Environment", "RoadCondition", "frictionScaleFactor!"),
    no_effect("RoadCondition", "@wetness", WETNESS),
    read("GlobalAction", "EntityAction", "entityRef!"),
    read("EntityAction", "AddEntityAction|DeleteEntityAction", ""),
    refused("GlobalAction", "InfrastructureAction", SIGNALS),
    refused("GlobalAction", "TrafficAction", SWARMS),
    refused("Action|Actions", "UserDefinedAction", COMMANDS).several(),
    read("Actions", "Private", "entityRef!").several(),
    read("Action|Private!", "PrivateAction", "").several(),
    read("PrivateAction", "LongitudinalAction|LateralAction|ControllerAction|TeleportAction|RoutingAction", ""),
    read("LongitudinalAction", "SpeedAction", ""),
    read("SpeedAction!", "SpeedActionDynamics", "dynamicsDimension! dynamicsShape! followingMode value!"),
    no_effect("SpeedActionDynamics", "@followingMode", EXACT).valued(FOLLOWING, "position"),
    read("SpeedAction!", "SpeedActionTarget", ""),
    read("SpeedActionTarget", "RelativeTargetSpeed", "entityRef! continuous! speedTargetValueType! value!"),
    read("SpeedActionTarget", "AbsoluteTargetSpeed", "value!"),
    read(
        "LongitudinalAction",
        "LongitudinalDistanceAction",
        "entityRef! continuous! distance freespace! timeGap displacement coordinateSystem",
    ),
    read(
        "LateralDistanceAction|LongitudinalDistanceAction|SpeedProfileAction",
        "DynamicConstraints",
        "maxAcceleration maxAccelerationRate maxDeceleration maxDecelerationRate maxSpeed",
    ),
    read("LateralAction", "LaneChangeAction", "targetLaneOffset"),
    read("LaneChangeAction!", "LaneChangeActionDynamics", "dynamicsDimension! dynamicsShape! followingMode value!"),
    no_effect("LaneChangeActionDynamics", "@followingMode", EXACT).valued(FOLLOWING, "position"),
    read("LaneChangeAction!", "LaneChangeTarget", ""),
    read("LaneChangeTarget", "RelativeTargetLane", "entityRef! value!"),
    read("LaneChangeTarget", "AbsoluteTargetLane", "value!"),
    read("LateralAction", "LaneOffsetAction", "continuous!"),
    read("LaneOffsetAction!", "LaneOffsetActionDynamics", "dynamicsShape! maxLateralAcc"),
    read("LaneOffsetAction!", "LaneOffsetTarget", ""),
    read("LaneOffsetTarget", "RelativeTargetLaneOffset", "entityRef! value!"),
    read("LaneOffsetTarget", "AbsoluteTargetLaneOffset", "value!"),
    read(
        "LateralAction",
        "LateralDistanceAction",
        "continuous! coordinateSystem displacement distance entityRef! freespace!",
    ),
    no_effect("PrivateAction", "AppearanceAction", LOOKS),
    read("PrivateAction", "VisibilityAction", "graphics! sensors! traffic!"),
    refused("VisibilityAction", "@sensors|@traffic", ALL_SEEN).valued(Form::Truth, "true"),
    no_effect("VisibilityAction", "SensorReferenceSet", "sensors see all entities"),
    no_effect("VisibilityAction", "@graphics", "pictures have all entities").valued(Form::Truth, "true"),
    read(
        "ControllerAction|PrivateAction",
        "ActivateControllerAction",
        "controllerRef objectControllerRef lateral longitudinal animation lighting",
    ),
    read(
        "ControllerAction",
        "AssignControllerAction",
        "activateAnimation activateLateral activateLighting activateLongitudinal",
    ),
    no_effect("ActivateControllerAction", "@controllerRef|@objectControllerRef", DRIVER),
    no_effect("ActivateControllerAction", "@animation|@lighting", LOOKS).valued(Form::Truth, "false"),
    no_effect("AssignControllerAction", "@activateAnimation|@activateLighting", LOOKS).valued(Form::Truth, "false"),
    no_effect("AssignControllerAction", "CatalogReference|Controller|ObjectController", DRIVER),
    refused("ControllerAction", "OverrideControllerValueAction", CONTROL),
    read("RoutingAction", "AssignRouteAction|AcquirePositionAction", ""),
    refused("RoutingAction", "RandomRouteAction", ROUTES),
    read("RoutingAction", "FollowTrajectoryAction", "initialDistanceOffset"),
    read("FollowTrajectoryAction!", "TimeReference", ""),
    read("TimeReference", "None", ""),
    read("TimeReference", "Timing", "domainAbsoluteRelative! offset! scale!"),
    read("FollowTrajectoryAction!", "TrajectoryFollowingMode", "followingMode!"),
    no_effect("TrajectoryFollowingMode", "@followingMode", EXACT).valued(FOLLOWING, "position"),
    refused("PrivateAction", "TrailerAction", TRAILERS),
    read("Storyboard", "Story", "name!").several(),
    read("Story!", "Act", "name!").several(),
    read("Act!", "ManeuverGroup", "maximumExecutionCount! name!").several(),
    read("ManeuverGroup!", "Actors", "selectTriggeringEntities!"),
    refused("Actors", "@selectTriggeringEntities", NAMED).valued(Form::Truth, "false"),
    read("Catalog|ManeuverGroup", "Maneuver", "name!").several(),
    read("Maneuver!", "Event", "maximumExecutionCount name! priority!").several(),
    read("Event!", "Action", "name!").several(),
    read("Act|Event", "StartTrigger", ""),
    read("StartTrigger|StopTrigger", "ConditionGroup", "").several(),
    read("ConditionGroup!", "Condition", "conditionEdge! delay! name!").several(),
    read("Condition", "ByEntityCondition|ByValueCondition", ""),
    read("ByEntityCondition!", "TriggeringEntities", "triggeringEntitiesRule!"),
    read("ByEntityCondition!", "EntityCondition", ""),
    read("EntityCondition", "EndOfRoadCondition|StandStillCondition", "duration!"),
    read("EntityCondition", "CollisionCondition", ""),
    read("EntityCondition", "OffroadCondition", "duration!"),
    read("EntityCondition", "RelativeClearanceCondition", "distanceBackward distanceForward freeSpace! oppositeLanes!"),
    read("RelativeClearanceCondition", "RelativeLaneRange", "from to").several(),
    read("RelativeClearanceCondition", "EntityRef", "entityRef!").several(),
    read("EntityCondition", "AngleCondition", "angle! angleTolerance! angleType! coordinateSystem"),
    read("EntityCondition", "RelativeAngleCondition", "angle! angleTolerance! angleType! coordinateSystem entityRef!"),
    refused("AngleCondition|RelativeAngleCondition", "@angleType", FLAT_ANGLES)
        .valued(Form::OneOf("heading|pitch|roll"), "heading"),
    read(
        "EntityCondition",
        "TimeHeadwayCondition",
        "entityRef! alongRoute freespace! rule! value! coordinateSystem relativeDistanceType routingAlgorithm",
    ),
    read(
        "EntityCondition",
        "TimeToCollisionCondition",
        "alongRoute freespace! rule! value! relativeDistanceType coordinateSystem routingAlgorithm",
    ),
    read("TimeToCollisionCondition!", "TimeToCollisionConditionTarget", ""),
    read("EntityCondition", "AccelerationCondition|SpeedCondition", "rule! value! direction"),
    read("EntityCondition", "RelativeSpeedCondition", "entityRef! rule! value! direction"),
    read("EntityCondition", "TraveledDistanceCondition", "value!"),
    read("EntityCondition", "ReachPositionCondition", "tolerance!"),
    read(
        "EntityCondition",
        "DistanceCondition",
        "alongRoute freespace! rule! value! coordinateSystem relativeDistanceType routingAlgorithm",
    ),
    read(
        "EntityCondition",
        "RelativeDistanceCondition",
        "entityRef! freespace! relativeDistanceType! rule! value! coordinateSystem routingAlgorithm",
    ),
    no_effect(
        "DistanceCondition|RelativeDistanceCondition|TimeHeadwayCondition|TimeToCollisionCondition",
        "@routingAlgorithm",
        ALWAYS_SHORTEST,
    )
    .valued(ROUTING, "undefined"),
    read("ByValueCondition", "ParameterCondition", "parameterRef! rule! value!"),
    read("ByValueCondition", "TimeOfDayCondition", "dateTime! rule!"),
    read("ByValueCondition", "SimulationTimeCondition", "rule! value!"),
    read("ByValueCondition", "StoryboardElementStateCondition", "storyboardElementRef! state! storyboardElementType!"),
    refused("ByValueCondition", "UserDefinedValueCondition", COMMANDS),
    refused("ByValueCondition", "TrafficSignalCondition|TrafficSignalControllerCondition", SIGNALS),
    read("Act|Storyboard", "StopTrigger", ""),
    read("OpenSCENARIO", "Catalog", "name"),
    read("ParameterValueDistribution!", "ScenarioFile", "filepath!"),
    read("ParameterValueDistribution", "Deterministic", ""),
    read("Deterministic", "DeterministicMultiParameterDistribution", "").several(),
    read("DeterministicMultiParameterDistribution!", "ValueSetDistribution", ""),
    read("ValueSetDistribution!", "ParameterValueSet", "").several(),
    read("Deterministic", "DeterministicSingleParameterDistribution", "parameterName!").several(),
    read("DeterministicSingleParameterDistribution", "DistributionSet", ""),
    read("DistributionSet!", "Element", "value!").several(),
    read("DeterministicSingleParameterDistribution", "DistributionRange", "stepWidth!"),
    read("DistributionRange!", "Range", "lowerLimit! upperLimit!"),
    refused("DeterministicSingleParameterDistribution", "UserDefinedDistribution", COMMANDS),
    read("ParameterValueDistribution", "Stochastic", "numberOfTestRuns! randomSeed"),
    no_effect("Stochastic", "@numberOfTestRuns", "use the option --budget").valued(Form::Count, ""),
    no_effect("Stochastic", "@randomSeed", "use the option --seed").valued(Form::Number, ""),
    read("Stochastic!", "StochasticDistribution", "parameterName!").several(),
    read("StochasticDistribution", "UniformDistribution", ""),
    read("StochasticDistribution", "NormalDistribution", "expectedValue! variance!"),
    read("StochasticDistribution", "LogNormalDistribution", "expectedValue! variance!"),
    read("StochasticDistribution", "PoissonDistribution", "expectedValue!"),
    read(
        "UniformDistribution!|NormalDistribution|LogNormalDistribution|PoissonDistribution",
        "Range",
        "lowerLimit! upperLimit!",
    ),
    read("StochasticDistribution", "Histogram", ""),
    read("Histogram!", "Bin", "weight!").several(),
    read("Bin!", "Range", "lowerLimit! upperLimit!"),
    read("StochasticDistribution", "ProbabilityDistributionSet", ""),
    read("ProbabilityDistributionSet!", "Element", "value! weight!").several(),
    refused("StochasticDistribution", "UserDefinedDistribution", COMMANDS),
    read("OpenSCENARIO", "VariableDeclarations", ""),
    read("VariableDeclarations", "VariableDeclaration", "name! variableType! value!").several(),
    read("GlobalAction", "VariableAction", "variableRef!"),
    read("VariableAction", "SetAction", "value!"),
    read("VariableAction", "ModifyAction", ""),
    read("ModifyAction!", "Rule", ""),
    read("Rule", "AddValue", "value!"),
    read("Rule", "MultiplyByValue", "value!"),
    read("ByValueCondition", "VariableCondition", "variableRef! rule! value!"),
    read("GlobalAction", "ParameterAction", "parameterRef!"),
    read("ParameterAction", "SetAction", "value!"),
    read("ParameterAction", "ModifyAction", ""),
    refused("GlobalAction", "SetMonitorAction", OTHERS),
    read("LongitudinalAction", "SpeedProfileAction", "entityRef followingMode!"),
    read("SpeedProfileAction!", "SpeedProfileEntry", "speed! time").several(),
    read("PrivateAction", "SynchronizeAction", "masterEntityRef! targetToleranceMaster targetTolerance"),
    read("SynchronizeAction!", "TargetPositionMaster|TargetPosition", ""),
    read("SynchronizeAction", "FinalSpeed", ""),
    read("FinalSpeed", "AbsoluteSpeed", "value!"),
    read("AbsoluteSpeed|RelativeSpeedToMaster", "TargetDistanceSteadyState", "distance!"),
    read("AbsoluteSpeed|RelativeSpeedToMaster", "TargetTimeSteadyState", "time!"),
    read("FinalSpeed", "RelativeSpeedToMaster", "speedTargetValueType! value!"),
    read("Position|TargetPosition|TargetPositionMaster", "TrajectoryPosition", "s! t"),
    read("Shape", "Clothoid", "curvature! curvaturePrime curvatureDot length! startTime stopTime"),
    read("Clothoid!", "Position", ""),
    read("Shape", "ClothoidSpline", "timeEnd"),
    read("ClothoidSpline!", "ClothoidSplineSegment", "curvatureStart! curvatureEnd! length! hOffset timeStart")
        .several(),
    read("ClothoidSplineSegment", "PositionStart", ""),
    read("PositionStart", "WorldPosition", "h p r x! y! z"),
    read("PositionStart", "LanePosition", "laneId! offset roadId! s!"),
    read("PositionStart", "RoadPosition", "roadId! s! t!"),
    refused(
        "PositionStart",
        "GeoPosition|RelativeLanePosition|RelativeObjectPosition|RelativeRoadPosition|RelativeWorldPosition|RoutePosition|\
         TrajectoryPosition",
        "use a WorldPosition, a LanePosition or a RoadPosition",
    ),
    read("Shape", "Nurbs", "order!"),
    read("Nurbs!", "ControlPoint", "time weight").several(),
    read("ControlPoint!", "Position", ""),
    read("Nurbs!", "Knot", "value!").several(),
];

/// The elements that contain one of several elements.
const CHOICES: &[Choice] = &[
    Choice {
        parents: "AbsoluteSpeed|Action|AssignControllerAction|AssignRouteAction|ByValueCondition|CollisionCondition|Condition|\
                  DeterministicMultiParameterDistribution|DeterministicSingleParameterDistribution|EntityAction|\
                  EntityCondition|EnvironmentAction|FinalSpeed|GlobalAction|InRoutePosition|LaneChangeTarget|\
                  LaneOffsetTarget|LateralAction|LongitudinalAction|ModifyAction|ObjectController|ParameterAction|Position|\
                  PositionStart|PrivateAction|RelativeSpeedToMaster|RouteRef|RoutingAction|Rule|Shape|SpeedActionTarget|\
                  StochasticDistribution|TargetPosition|TargetPositionMaster|TimeReference|TimeToCollisionConditionTarget|\
                  TrajectoryRef|VariableAction",
        beside: "",
    },
    Choice { parents: "FollowTrajectoryAction", beside: "TimeReference|TrajectoryFollowingMode" },
    Choice { parents: "OpenSCENARIO", beside: OF_ALL_FILES },
    Choice { parents: "ParameterValueDistribution", beside: "ScenarioFile" },
    Choice { parents: "ScenarioObject", beside: "ObjectController" },
];
/// The elements that stand beside the storyboard, the catalog or the distribution of a file.
const OF_ALL_FILES: &str =
    "FileHeader|ParameterDeclarations|VariableDeclarations|MonitorDeclarations|CatalogLocations|RoadNetwork|Entities";

/// Returns the table of OpenSCENARIO.
pub(super) fn schema() -> &'static Schema {
    static SCHEMA: LazyLock<Schema> = LazyLock::new(|| Schema::new(ROWS, Counts::OnceExcept(CHOICES)));
    &SCHEMA
}

/// Returns all elements of OpenSCENARIO, without the contents of elements that have no effect or are refused.
pub fn elements() -> impl Iterator<Item = Supported> {
    ROWS.iter().flat_map(Row::each)
}
