"""One rule for each declared stage; `stiction.plan.stage` describes the declarations, which are in the modules of the stages."""

for declared in planner.rules:

    rule:
        name:
            declared["name"]
        input:
            unpack(inputs_of(declared)),
        output:
            **outputs_of(declared),
        log:
            declared["log"],
        wildcard_constraints:
            **declared["constraints"],
        priority: declared["priority"]
        localrule: not declared["cluster"]
        resources:
            runtime=minutes_of(declared),
            mem_mb=memory_of(declared),
            cpu_s=seconds_of(declared),
        params:
            module=declared["module"],
            stage=declared["name"],
            inputs=of_job(declared, "inputs"),
            settings=of_job(declared, "settings"),
            code=planner.code(declared) | SCRIPT,
        message:
            declared["message"]
        script:
            "../scripts/stage.py"
