classdef Counter < handle
% COUNTER  A handle class: copies count together.
    properties
        count = 0;
        step
    end
    methods
        function obj = Counter(step)
            if nargin < 1, step = 1; end
            obj.step = step;
        end
        function add(obj)
            obj.count = obj.count + obj.step;
        end
    end
    methods (Static)
        function y = twice(x)
            y = 2 * x;
        end
    end
end
