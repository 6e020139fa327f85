/** Names of the wire schema, which is generated from openapi.yaml. */
import type { components } from "./schema";

type Schemas = components["schemas"];

export type Alias = Schemas["Alias"];
export type Batch = Schemas["Batch"];
export type BatchPage = Schemas["BatchPage"];
export type Event = Schemas["Event"];
export type FillReport = Schemas["FillReport"];
export type Hole = Schemas["Hole"];
export type HoleReport = Schemas["HoleReport"];
export type HoleRule = Schemas["HoleRule"];
export type Job = Schemas["Job"];
export type JobPage = Schemas["JobPage"];
export type JobSpec = Schemas["JobSpec"];
export type JobState = Schemas["JobState"];
export type Key = Schemas["Key"];
export type KeyList = Schemas["KeyList"];
export type KeyWithSecret = Schemas["KeyWithSecret"];
export type Limits = Schemas["CallerLimits"];
export type Mesh = Schemas["Mesh"];
export type MeshPage = Schemas["MeshPage"];
export type MeshSummary = Schemas["MeshSummary"];
export type Model = Schemas["Model"];
export type ModelList = Schemas["ModelList"];
export type ModelVersion = Schemas["ModelVersion"];
export type NewBatch = Schemas["NewBatch"];
export type NewKey = Schemas["NewKey"];
export type Plan = Schemas["Plan"];
export type PlannedHole = Schemas["PlannedHole"];
export type ProblemDocument = Schemas["Problem"];
export type Rule = Schemas["Rule"];
export type RuleContent = Schemas["RuleContent"];
export type RulePage = Schemas["RulePage"];
export type Scope = Schemas["Scope"];
export type Version = Schemas["Version"];
export type WarningDetail = Schemas["WarningDetail"];
